//! Guards the inventory: all 61 codes, their classes and what they map to, against TIMIT's own list.

use std::collections::HashSet;

use mouthpiece_phonemes::{Class, Phone, nearest};

/// TIMIT's `phoncode.doc`, by its headings.
const CODES: [(Class, &str); 8] = [
    (Class::Stop, "b d g p t k dx q"),
    (Class::Affricate, "jh ch"),
    (Class::Fricative, "s sh z zh f th v dh"),
    (Class::Nasal, "m n ng em en eng nx"),
    (Class::Semivowel, "l r w y hh hv el"),
    (
        Class::Vowel,
        "iy ih eh ey ae aa aw ay ah ao oy ow uh uw ux er ax ix axr ax-h",
    ),
    (Class::Closure, "bcl dcl gcl pcl tcl kcl"),
    (Class::Silence, "pau epi h#"),
];

/// The phones of the CMU dictionary.
const CMU: &str = "AA AE AH AO AW AY B CH D DH EH ER EY F G HH IH IY JH K L M N NG OW OY P R S SH \
                   T TH UH UW V W Y Z ZH SIL";

#[test]
fn all_61_codes_of_timit_have_their_class_and_read_back() {
    let mut seen = HashSet::new();
    for (class, codes) in CODES {
        for code in codes.split(' ') {
            let phone = Phone::from_code(code).unwrap_or_else(|| panic!("{code} is missing"));
            assert_eq!(phone.class(), class, "{code}");
            assert_eq!(phone.code(), code);
            assert_eq!(code.parse(), Ok(phone));
            let json = serde_json::to_string(&phone).unwrap();
            assert_eq!(json, format!("\"{code}\""));
            assert_eq!(serde_json::from_str::<Phone>(&json).unwrap(), phone);
            seen.insert(phone);
        }
    }
    assert_eq!(seen.len(), 61);
    for (index, phone) in Phone::ALL.into_iter().enumerate() {
        assert!(seen.contains(&phone), "{phone} is not TIMIT's");
        assert_eq!(phone.index(), index);
    }
}

#[test]
fn ipa_and_cmu_are_there_for_every_sound() {
    let cmu: HashSet<&str> = CMU.split_whitespace().collect();
    let mut ipa = HashSet::new();
    let mut reached = HashSet::new();
    for phone in Phone::ALL {
        assert_eq!(phone.ipa().is_empty(), phone.is_silence(), "{phone}");
        assert!(
            phone.is_silence() || ipa.insert(phone.ipa()),
            "{phone}: two phones share an IPA symbol"
        );
        for symbol in phone.cmu() {
            let bare = symbol.trim_end_matches(|c: char| c.is_ascii_digit());
            assert!(cmu.contains(bare), "{phone}: {symbol}");
            reached.insert(bare.to_owned());
        }
        let silent = phone.is_closure() || matches!(phone, Phone::Q | Phone::Epi);
        assert_eq!(phone.cmu().is_empty(), silent, "{phone}");
    }
    assert_eq!(reached.len(), cmu.len(), "some CMU phone is never reached");
    assert_eq!(Phone::Ax.cmu(), ["AH0"]);
    assert_eq!(Phone::El.cmu(), ["AH0", "L"]);
}

#[test]
fn helpers_name_the_phones_that_shape_the_lips() {
    let which = |test: fn(Phone) -> bool| {
        let codes = Phone::ALL.into_iter().filter(|p| test(*p));
        codes.map(Phone::code).collect::<Vec<_>>().join(" ")
    };
    assert_eq!(which(Phone::is_bilabial), "m em b p bcl pcl");
    assert_eq!(which(Phone::is_labiodental), "f v");
    assert_eq!(which(Phone::is_closure), "bcl dcl gcl pcl tcl kcl");
    assert_eq!(which(Phone::is_silence), "pau epi h#");
    assert_eq!(which(|p| p.closure().is_some()), "jh ch b d g p t k");
    assert_eq!(Phone::Ch.closure(), Some(Phone::Tcl));
}

#[test]
fn an_unknown_code_is_answered_with_the_codes_it_resembles() {
    assert_eq!(nearest("AH0"), [Phone::Ah]);
    assert_eq!(nearest("sil"), [Phone::HSharp, Phone::Pau]);
    assert_eq!(nearest("#h"), [Phone::HSharp]);
    assert!(nearest("axrr").contains(&Phone::Axr));
    assert!(!nearest("ə").is_empty());
    assert!(nearest(&"x".repeat(1000)).is_empty());
    let error = "AA1".parse::<Phone>().unwrap_err().to_string();
    assert_eq!(error, "`AA1` is not a TIMIT phone code; nearest: `aa`");
}
