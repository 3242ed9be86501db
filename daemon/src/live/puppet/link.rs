//! The socket to a driven avatar, and what is spoken through it.
//!
//! A machine beyond this one is driven because the user names it; groups of machines (broadcast,
//! multicast) never are.

use std::io::ErrorKind;
use std::net::{Ipv4Addr, Ipv6Addr, SocketAddr, ToSocketAddrs as _, UdpSocket};

use anyhow::{Context as _, Result};

use super::{Moment, livelink, osc, vmc};
use crate::cli::{DriveArg, Says, Usage};

/// An open way to an avatar.
pub(super) struct Link {
    target: DriveArg,
    socket: UdpSocket,
    packets: Vec<Vec<u8>>,
    told: bool,
}

impl Link {
    /// Looks the host up and opens a socket to it that never waits.
    pub(super) fn open(target: &DriveArg) -> Result<Self> {
        let refused = || format!("--drive {target}: nothing can be sent there");
        let found = (target.host.as_str(), target.port).to_socket_addrs();
        // A name of both kinds: receivers of this sort rarely listen on IPv6.
        let mut found: Vec<SocketAddr> = found.with_context(refused)?.collect();
        found.sort_by_key(SocketAddr::is_ipv6);
        let address = *found.first().with_context(refused)?;
        DriveArg::check_ip(address.ip())
            .map_err(|why| Usage(format!("--drive {target}: {why}")))?;
        let any: SocketAddr = match address {
            SocketAddr::V4(_) => (Ipv4Addr::UNSPECIFIED, 0).into(),
            SocketAddr::V6(_) => (Ipv6Addr::UNSPECIFIED, 0).into(),
        };
        let socket = UdpSocket::bind(any).with_context(refused)?;
        // The broadcast address of a network is refused here, by the system.
        socket.connect(address).with_context(refused)?;
        socket.set_nonblocking(true).with_context(refused)?;
        tracing::info!(avatar = %target, "driving");
        Ok(Self {
            target: target.clone(),
            socket,
            packets: Vec::new(),
            told: false,
        })
    }

    /// Sends what the face does; what cannot be sent now is lost.
    pub(super) fn send(&mut self, moment: &Moment<'_>) {
        self.packets.clear();
        match self.target.says {
            Says::Vrm1 | Says::Vrm0 | Says::VmcArkit => {
                let messages = vmc::messages(moment, self.target.says);
                osc::pack(messages, &mut self.packets);
            }
            Says::Osc => osc::pack(osc::messages(moment), &mut self.packets),
            Says::LiveLink => self.packets.push(livelink::packet(moment)),
        }
        for packet in &self.packets {
            let Err(error) = self.socket.send(packet) else {
                continue;
            };
            // Refused: nobody listens there, or not yet.
            if error.kind() != ErrorKind::WouldBlock && !std::mem::replace(&mut self.told, true) {
                tracing::warn!(avatar = %self.target, "{error}; it is tried again and again");
            }
        }
    }
}
