//! TCP sockets: bound, and accepted so that a client that vanishes without a word is noticed.
//!
//! A machine that loses its power or its cable closes nothing: its half of the connection stays open. While
//! nothing is on the way to it, keepalive asks whether it is there; while answers are, they are sent again
//! and again, which the system would go on with for a quarter of an hour. Both end after a minute here; the
//! connection then reads an error, and what its client began ends as with any client that is gone.

use std::net::SocketAddr;
use std::time::Duration;

use anyhow::{Context as _, Result};
use socket2::{SockRef, TcpKeepalive};
use tokio::net::{TcpListener, TcpStream};

/// Silence before a client is asked whether it is there, time between questions, and how many of them.
const KEEPALIVE: (Duration, Duration, u32) = (Duration::from_secs(30), Duration::from_secs(10), 3);
/// How long answers may be on the way: as long as the questions take in all.
const UNREACHABLE: Duration = Duration::from_secs(60);

pub(super) async fn bind(address: SocketAddr) -> Result<TcpListener> {
    let bound = TcpListener::bind(address).await;
    bound.with_context(|| format!("cannot listen at {address}; give --listen another port"))
}

/// The next client: small answers leave at once, and its silent end is noticed.
pub(super) async fn accept(listener: &TcpListener) -> std::io::Result<TcpStream> {
    let stream = listener.accept().await?.0;
    stream.set_nodelay(true)?;
    let socket = SockRef::from(&stream);
    let (time, interval, retries) = KEEPALIVE;
    let keepalive = TcpKeepalive::new().with_time(time).with_interval(interval);
    socket.set_tcp_keepalive(&keepalive.with_retries(retries))?;
    #[cfg(target_os = "linux")]
    socket.set_tcp_user_timeout(Some(UNREACHABLE))?;
    Ok(stream)
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    /// What the system makes of it cannot be seen without the right to drop packets; that it is told can. (Seen
    /// once, in a network namespace whose loopback was taken down: an idle client was gone after 61 s, one with
    /// answers on the way after 62 s.)
    #[tokio::test]
    async fn a_client_that_vanishes_is_noticed_within_a_minute() {
        let listener = bind(SocketAddr::from(([127, 0, 0, 1], 0))).await.unwrap();
        let address = listener.local_addr().unwrap();
        let (client, served) = tokio::join!(TcpStream::connect(address), accept(&listener));
        let (_client, served) = (client.unwrap(), served.unwrap());
        let socket = SockRef::from(&served);
        assert!(socket.keepalive().unwrap() && socket.tcp_nodelay().unwrap());
        let asked =
            socket.tcp_keepalive_retries().unwrap() * socket.tcp_keepalive_interval().unwrap();
        let noticed = socket.tcp_keepalive_time().unwrap() + asked;
        assert_eq!(
            noticed,
            Duration::from_secs(60),
            "while nothing is on the way"
        );
        let timeout = socket.tcp_user_timeout().unwrap();
        assert_eq!(timeout, Some(noticed), "while answers are on the way");
    }
}
