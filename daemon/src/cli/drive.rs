//! What `--drive` means: `KIND:HOST[:PORT]`.

use std::fmt;
use std::net::{IpAddr, Ipv4Addr};
use std::str::FromStr;

/// What an avatar's program understands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Says {
    /// VMC protocol with the expressions of VRM 1.0.
    Vrm1,
    /// VMC protocol with the expressions of VRM 0.x.
    Vrm0,
    /// VMC protocol with ARKit's 52 shapes ("perfect sync").
    VmcArkit,
    /// Live Link Face's packet.
    LiveLink,
    /// Plain OSC.
    Osc,
}

/// The word for each, and the port where its receivers listen unless told otherwise.
const KINDS: [(&str, Says, Option<u16>); 5] = [
    ("vmc", Says::Vrm1, Some(39_539)),
    ("vmc0", Says::Vrm0, Some(39_539)),
    ("vmc-arkit", Says::VmcArkit, Some(39_539)),
    ("livelink", Says::LiveLink, Some(11_111)),
    ("osc", Says::Osc, None),
];

/// An avatar's address.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DriveArg {
    pub says: Says,
    /// A name, or an address without brackets.
    pub host: String,
    pub port: u16,
}

impl DriveArg {
    /// Avatars of one process: each costs a few packets every sixtieth of a second.
    const MAX: usize = 8;

    /// Refuses more than there may be.
    pub fn check(all: &[Self]) -> Result<(), String> {
        if all.len() > Self::MAX {
            return Err(format!("at most {} avatars at once", Self::MAX));
        }
        Ok(())
    }

    /// Refuses groups of machines, which nobody named one by one, and what is no place at all.
    pub fn check_ip(ip: IpAddr) -> Result<(), String> {
        let ip = ip.to_canonical();
        if ip.is_multicast() || ip == IpAddr::V4(Ipv4Addr::BROADCAST) {
            return Err(format!("{ip} reaches many machines; name one"));
        }
        if ip.is_unspecified() {
            return Err(format!("{ip} is no place to send to; name a host"));
        }
        Ok(())
    }
}

impl FromStr for DriveArg {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let words = KINDS.map(|(word, ..)| word).join(", ");
        let (word, place) = text
            .split_once(':')
            .ok_or_else(|| format!("write KIND:HOST:PORT, KIND being one of {words}"))?;
        let (_, says, usual) = KINDS
            .into_iter()
            .find(|(known, ..)| *known == word)
            .ok_or_else(|| format!("`{word}` is none of {words}"))?;
        // An IPv6 address stands in brackets before a port; without one its colons are its own.
        let (host, port) = match place.rsplit_once(':') {
            Some((host, port)) if !host.contains(':') || host.ends_with(']') => (host, Some(port)),
            _ => (place, None),
        };
        let port = match port {
            Some(port) => port.parse().ok().filter(|port| *port > 0),
            None => usual,
        };
        let port = port.ok_or("give the port after the host, as HOST:9000")?;
        let host = host.trim_start_matches('[').trim_end_matches(']');
        if host.is_empty() {
            return Err("give the host, as in osc:127.0.0.1:9000".into());
        }
        if let Ok(ip) = host.parse() {
            Self::check_ip(ip)?;
        }
        Ok(Self {
            says,
            host: host.to_owned(),
            port,
        })
    }
}

impl fmt::Display for DriveArg {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let word = KINDS.iter().find(|(_, says, _)| *says == self.says);
        let word = word.map_or("", |(word, ..)| *word);
        if self.host.contains(':') {
            write!(f, "{word}:[{}]:{}", self.host, self.port)
        } else {
            write!(f, "{word}:{}:{}", self.host, self.port)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<String, String> {
        text.parse().map(|target: DriveArg| target.to_string())
    }

    #[test]
    fn targets_are_read_as_the_help_says() {
        for (text, meant) in [
            ("vmc:127.0.0.1", "vmc:127.0.0.1:39539"),
            ("vmc0:localhost:39540", "vmc0:localhost:39540"),
            ("vmc-arkit:[::1]", "vmc-arkit:[::1]:39539"),
            ("vmc:::1", "vmc:[::1]:39539"),
            ("livelink:stage.example", "livelink:stage.example:11111"),
            ("osc:[::1]:9000", "osc:[::1]:9000"),
        ] {
            assert_eq!(read(text).as_deref(), Ok(meant));
            assert_eq!(read(meant).as_deref(), Ok(meant));
        }
    }

    #[test]
    fn what_is_no_single_machine_is_refused() {
        for (text, said) in [
            ("127.0.0.1:9000", "none of vmc"),
            ("vmc", "KIND:HOST:PORT"),
            ("midi:127.0.0.1:9000", "`midi`"),
            ("osc:127.0.0.1", "port"),
            ("osc::9000", "host"),
            ("osc:224.0.0.1:9000", "many machines"),
            ("osc:[ff02::1]:9000", "many machines"),
            ("osc:255.255.255.255:9000", "many machines"),
            ("osc:[::ffff:255.255.255.255]:9000", "many machines"),
            ("osc:0.0.0.0:9000", "no place"),
            ("osc:127.0.0.1:0", "port"),
            ("osc:127.0.0.1:99999", "port"),
        ] {
            let why = read(text).unwrap_err();
            assert!(why.contains(said), "{text}: {why}");
        }
    }
}
