//! How many videos are made at once: as many as there are cores for, and memory.
//!
//! Each video says beforehand what it will take; it begins when that much is left, or when nothing else runs.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use crate::cli::{ExportArgs, TierArg};
use crate::interrupt::{self, Interrupted};

/// What a video takes at any size: a head with its maps on the device, key frames, shaders as machine code. Measured in
/// software, where all of it is the processor's memory: each further video of 320x240 in the low tier took 190 MB.
const LOW_BYTES: u64 = 200 << 20;

/// The same with the larger maps of the other tiers: 200 MB more.
const FINE_BYTES: u64 = 400 << 20;

/// What each pixel takes, in pictures under way, their samples and the encoder: measured 70 in the low tier and 160 in the
/// high one, from 640x480 to 1920x1080.
const PIXEL_BYTES: u64 = 160;

/// A byte of a sound file in memory: 8 bits at 16 kHz become 32 at 48, twice, of which one is in the making.
const SOUND_FACTOR: u64 = 24;

/// Of what is free, this share is used: others live here, too.
const SHARE: f64 = 0.8;

/// Cores that one video keeps busy.
const CORES_A_VIDEO: usize = 2;

/// How often a worker that waits for memory looks for Ctrl-C.
const LOOK: Duration = Duration::from_millis(200);

/// How many workers there are where the user does not say.
pub fn workers() -> usize {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    cores.div_ceil(CORES_A_VIDEO)
}

/// What a video will take, bytes.
pub fn cost(args: &ExportArgs) -> u64 {
    let pixels = u64::from(args.size.width) * u64::from(args.size.height);
    let video = match args.look.tier {
        TierArg::Low => LOW_BYTES,
        TierArg::Medium | TierArg::High => FINE_BYTES,
    };
    let sound = args
        .input
        .audio
        .as_deref()
        .and_then(|path| fs::metadata(path).ok());
    video + pixels * PIXEL_BYTES + sound.map_or(0, |file| file.len()) * SOUND_FACTOR
}

/// Memory for videos.
pub struct Budget {
    total: u64,
    used: Mutex<u64>,
    returned: Condvar,
}

impl Budget {
    /// Of what is free now.
    pub fn of_this_machine() -> Self {
        Self::new(free().map_or(u64::MAX, |free| (free as f64 * SHARE) as u64))
    }

    fn new(total: u64) -> Self {
        Self {
            total,
            used: Mutex::new(0),
            returned: Condvar::new(),
        }
    }

    /// Waits until `bytes` are left. The first always gets what it asks for, or nothing would ever be made.
    pub fn take(&self, bytes: u64) -> Result<Share<'_>, Interrupted> {
        let mut used = self.used();
        while *used > 0 && used.saturating_add(bytes) > self.total {
            interrupt::check()?;
            let woken = self.returned.wait_timeout(used, LOOK);
            used = woken.unwrap_or_else(PoisonError::into_inner).0;
        }
        *used += bytes;
        Ok(Share { of: self, bytes })
    }

    fn used(&self) -> MutexGuard<'_, u64> {
        self.used.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Memory that one video may take; dropped, it goes back.
pub struct Share<'a> {
    of: &'a Budget,
    bytes: u64,
}

impl Share<'_> {
    /// Whether `bytes` fit in.
    pub fn covers(&self, bytes: u64) -> bool {
        bytes <= self.bytes
    }
}

impl Drop for Share<'_> {
    fn drop(&mut self) {
        *self.of.used() -= self.bytes;
        self.of.returned.notify_all();
    }
}

/// Bytes that this process may still take, where the system tells: of the machine, and of the group it is put in.
fn free() -> Option<u64> {
    let memory = fs::read_to_string("/proc/meminfo").ok()?;
    let machine = memory.lines().find_map(|line| {
        let kilobytes = line
            .strip_prefix("MemAvailable:")?
            .trim()
            .strip_suffix("kB")?;
        Some(kilobytes.trim().parse::<u64>().ok()? * 1024)
    });
    let groups = fs::read_to_string("/proc/self/cgroup").unwrap_or_default();
    let group = groups.lines().find_map(|line| line.strip_prefix("0::/"));
    let group = group.and_then(|group| in_group(Path::new("/sys/fs/cgroup"), Path::new(group)));
    machine.into_iter().chain(group).min()
}

/// What a control group and those above it leave (cgroup v2: a container's limit).
fn in_group(root: &Path, group: &Path) -> Option<u64> {
    let mut folder: PathBuf = root.join(group);
    let mut least = None;
    while folder.starts_with(root) {
        let read = |name: &str| fs::read_to_string(folder.join(name)).ok();
        let number = |name: &str| read(name)?.trim().parse::<u64>().ok();
        if let (Some(limit), Some(used)) = (number("memory.max"), number("memory.current")) {
            // Files that were read are given up when memory is wanted.
            let cached = read("memory.stat").and_then(|stat| {
                let line = stat
                    .lines()
                    .find_map(|line| line.strip_prefix("inactive_file "))?;
                line.parse::<u64>().ok()
            });
            let left = limit.saturating_sub(used.saturating_sub(cached.unwrap_or(0)));
            least = Some(least.map_or(left, |least: u64| least.min(left)));
        }
        if !folder.pop() {
            break;
        }
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_is_shared_out_and_comes_back() {
        let budget = Budget::new(100);
        // More than there is, when nothing else runs.
        drop(budget.take(1000).unwrap());
        let first = budget.take(60).unwrap();
        let second = budget.take(40).unwrap();
        assert!(second.covers(40) && !second.covers(41));
        std::thread::scope(|scope| {
            let third = std::thread::Builder::new()
                .name("third".into())
                .spawn_scoped(scope, || drop(budget.take(50).unwrap()))
                .unwrap();
            assert!(!third.is_finished());
            drop(first);
            third.join().unwrap();
        });
        drop(second);
        assert_eq!(*budget.used(), 0);
    }

    #[test]
    fn a_container_leaves_what_its_group_leaves() {
        let dir = tempfile::tempdir().unwrap();
        let group = dir.path().join("a/b");
        fs::create_dir_all(&group).unwrap();
        let write = |folder: &Path, max: &str, current: &str| {
            fs::write(folder.join("memory.max"), max).unwrap();
            fs::write(folder.join("memory.current"), current).unwrap();
        };
        write(&group, "max\n", "70\n");
        assert_eq!(in_group(dir.path(), Path::new("a/b")), None);
        write(&dir.path().join("a"), "1000\n", "700\n");
        fs::write(
            dir.path().join("a/memory.stat"),
            "anon 1\ninactive_file 200\n",
        )
        .unwrap();
        assert_eq!(in_group(dir.path(), Path::new("a/b")), Some(500));
        write(&group, "100\n", "70\n");
        assert_eq!(in_group(dir.path(), Path::new("a/b")), Some(30));
    }
}
