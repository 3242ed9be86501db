//! The socket file: its user's alone, or a group's, in a folder that nobody else can change.

use std::io::ErrorKind;
use std::os::unix::fs::{FileTypeExt as _, MetadataExt as _, PermissionsExt as _};
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, bail};
use nix::unistd::{Gid, Group, geteuid};
use tokio::net::UnixListener;

/// Of a socket that only its user can open, and of one that a group can, too.
const MODE: u32 = 0o600;
const GROUP_MODE: u32 = 0o660;

/// Removes the socket file when the daemon ends.
pub struct SocketFile(PathBuf);

impl SocketFile {
    pub fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for SocketFile {
    fn drop(&mut self) {
        if let Err(error) = std::fs::remove_file(&self.0) {
            tracing::debug!(path = %self.0.display(), %error, "the socket file stays");
        }
    }
}

/// Binds a socket file. It appears under its name when it is ready, in place of one that nobody answers
/// at any more.
pub async fn bind(path: &Path, group: Option<&str>) -> Result<(UnixListener, SocketFile)> {
    let name = path.display();
    let group = group.map(gid).transpose()?;
    check_folder(path)?;
    match tokio::net::UnixStream::connect(path).await {
        Ok(_) => {
            bail!("another mouthpiece listens at {name}; end it, or give --listen another place")
        }
        Err(error) if error.kind() == ErrorKind::NotFound => {}
        Err(error) => match std::fs::symlink_metadata(path) {
            Ok(there) if there.file_type().is_socket() => {
                tracing::info!(path = %name, "replacing the socket of a daemon that is gone");
            }
            Ok(_) => bail!("{name} is there and is no socket; give --listen another place"),
            Err(_) => return Err(error).with_context(|| format!("cannot look at {name}")),
        },
    }
    let mut fresh = path.as_os_str().to_owned();
    fresh.push(format!(".{}", std::process::id()));
    let fresh = PathBuf::from(fresh);
    // Left by a process of the same number that died in between.
    let _ = std::fs::remove_file(&fresh);
    let bound = listen(&fresh, path, group);
    if bound.is_err() {
        let _ = std::fs::remove_file(&fresh);
    }
    let listener = bound.with_context(|| match group {
        None => format!("cannot listen at {name}; does its folder exist, and is it yours?"),
        Some(_) => format!("cannot listen at {name} for that group; are you a member of it?"),
    })?;
    Ok((listener, SocketFile(path.to_owned())))
}

fn listen(fresh: &Path, path: &Path, group: Option<Gid>) -> std::io::Result<UnixListener> {
    let listener = UnixListener::bind(fresh)?;
    // The group first: nobody else's group may ever have the wider mode.
    if let Some(gid) = group {
        std::os::unix::fs::chown(fresh, None, Some(gid.as_raw()))?;
    }
    let mode = if group.is_some() { GROUP_MODE } else { MODE };
    std::fs::set_permissions(fresh, std::fs::Permissions::from_mode(mode))?;
    std::fs::rename(fresh, path)?;
    Ok(listener)
}

/// The group of this name or number.
fn gid(group: &str) -> Result<Gid> {
    if let Ok(number) = group.parse() {
        return Ok(Gid::from_raw(number));
    }
    let found = Group::from_name(group).with_context(|| format!("cannot look up `{group}`"))?;
    match found {
        Some(group) => Ok(group.gid),
        None => bail!("there is no group `{group}`; `getent group` lists them"),
    }
}

/// Whoever can change the folder can put a socket of their own in this one's place.
fn check_folder(path: &Path) -> Result<()> {
    let folder = path.parent().filter(|f| !f.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    let about = std::fs::metadata(folder)
        .with_context(|| format!("there is no folder {} for the socket", folder.display()))?;
    let user = geteuid().as_raw();
    if about.uid() != user && about.uid() != 0 {
        bail!(
            "{} belongs to another user, who could take the socket's place; give --listen a place in a folder of your own",
            folder.display()
        );
    }
    // In a sticky folder (/tmp) nobody can move what is another's.
    let (writable, sticky) = (about.mode() & 0o022 != 0, about.mode() & 0o1000 != 0);
    if writable && !sticky {
        bail!(
            "others can write to {} and could take the socket's place; chmod go-w {0}",
            folder.display()
        );
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn the_socket_is_its_users_or_a_groups_and_its_folder_safe() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("s");
        let mode = || std::fs::metadata(&path).unwrap().mode() & 0o777;
        drop(bind(&path, None).await.unwrap().0);
        // Forgotten by a daemon that died.
        std::os::unix::net::UnixListener::bind(&path).ok();
        let (_listener, file) = bind(&path, None).await.unwrap();
        assert_eq!(mode(), MODE);
        drop(file);
        assert!(!path.exists());

        let own = nix::unistd::getegid().as_raw();
        let (_listener, _file) = bind(&path, Some(&own.to_string())).await.unwrap();
        assert_eq!(mode(), GROUP_MODE);
        assert_eq!(std::fs::metadata(&path).unwrap().gid(), own);
        assert!(gid("no such group here").is_err());

        let open = std::fs::Permissions::from_mode(0o777);
        std::fs::set_permissions(folder.path(), open).unwrap();
        let why = bind(&folder.path().join("t"), None).await.err().unwrap();
        assert!(why.to_string().contains("chmod go-w"), "{why}");
    }
}
