//! The secret that lets clients in from beyond this machine.

use std::fmt;

use subtle::ConstantTimeEq as _;
use thiserror::Error;

/// Shorter ones can be guessed over a network.
pub const CHARS_MIN: usize = 16;
/// Longer ones are some other file.
pub const CHARS_MAX: usize = 256;

/// A token. It cannot be printed, and comparing takes as long whatever is right about a guess.
#[derive(Clone)]
pub struct Token(Box<[u8]>);

/// Text that is no token.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error(
    "a token is one line of {CHARS_MIN} to {CHARS_MAX} visible ASCII characters; make one: head -c 24 /dev/urandom | base64"
)]
pub struct TokenError;

impl Token {
    /// The token in `text`; white space around it does not count.
    ///
    /// # Errors
    /// When it is too short, too long, or cannot be typed.
    pub fn new(text: &str) -> Result<Self, TokenError> {
        let text = text.trim();
        let fits = (CHARS_MIN..=CHARS_MAX).contains(&text.len());
        if fits && text.bytes().all(|b| b.is_ascii_graphic()) {
            Ok(Self(text.as_bytes().into()))
        } else {
            Err(TokenError)
        }
    }

    /// Whether `guess` is it.
    #[must_use]
    pub fn is(&self, guess: &str) -> bool {
        self.0.ct_eq(guess.as_bytes()).into()
    }
}

impl fmt::Debug for Token {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Token(..)")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_whole_token_is_it_and_nobody_prints_it() {
        let token = Token::new(" 0123456789abcdef\n").unwrap();
        assert!(token.is("0123456789abcdef"));
        for guess in [
            "",
            "0123456789abcdeF",
            "0123456789abcde",
            "0123456789abcdef0",
        ] {
            assert!(!token.is(guess), "{guess}");
        }
        assert_eq!(format!("{token:?}"), "Token(..)");
    }

    #[test]
    fn what_is_no_token_is_refused() {
        for text in [
            "",
            "short",
            "0123456789abcde\u{e9}",
            &"x".repeat(300),
            "two words of sixteen",
        ] {
            assert!(Token::new(text).is_err(), "{text}");
        }
    }
}
