//! The memory of the machine, as the Linux kernel reports it.

use std::fs;
use std::path::{Path, PathBuf};

/// The available memory, as reported by the system.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Memory {
    /// The most bytes that this program can get in addition to its present memory, with all swap space.
    pub(super) most: Option<u64>,
    /// The bytes that the program can get without swapping.
    pub(super) free: Option<u64>,
    /// The bytes that the program has: the scene is already in memory.
    pub(super) own: u64,
}

impl Memory {
    /// Reads the files of the Linux kernel below `root`. On other systems the memory is unknown.
    pub(super) fn read(root: &Path) -> Memory {
        let info = Fields(fs::read_to_string(root.join("proc/meminfo")).unwrap_or_default());
        let own = Fields(fs::read_to_string(root.join("proc/self/status")).unwrap_or_default());
        let kibibytes = |fields: &Fields, name| fields.number(name).map(|number| number << 10);
        let swap = kibibytes(&info, "SwapTotal:").unwrap_or(0);
        let (mut most, mut free) = (
            kibibytes(&info, "MemTotal:").map(|total| total + swap),
            kibibytes(&info, "MemAvailable:"),
        );
        let least = |one: Option<u64>, other: u64| Some(one.map_or(other, |one| one.min(other)));
        for group in groups(root) {
            if let Some(limit) = group.limit() {
                let swap = group.swap(limit).map_or(swap, |allowed| allowed.min(swap));
                most = least(most, limit.saturating_add(swap));
                free = least(free, limit.saturating_sub(group.used()));
            }
        }
        let own = kibibytes(&own, "VmRSS:").unwrap_or(0);
        Memory { most: most.map(|most| most.saturating_sub(own)), free, own }
    }
}

/// A file of names and numbers, one pair per line.
struct Fields(String);

impl Fields {
    fn number(&self, name: &str) -> Option<u64> {
        let mut lines = self.0.lines().map(str::split_ascii_whitespace);
        lines.find_map(|mut words| (words.next()? == name).then(|| words.next())?)?.parse().ok()
    }
}

/// A control group of this program, of version 1 or 2.
#[derive(Debug)]
struct ControlGroup {
    folder: PathBuf,
    version: usize,
}

/// All groups that contain this program, from its own group to the root: each group may have a limit. In a container,
/// only the root may be visible.
fn groups(root: &Path) -> Vec<ControlGroup> {
    let list = fs::read_to_string(root.join("proc/self/cgroup")).unwrap_or_default();
    let mut groups = Vec::new();
    for line in list.lines() {
        let mut parts = line.splitn(3, ':').skip(1);
        let (Some(controllers), Some(path)) = (parts.next(), parts.next()) else { continue };
        let (mounted, version) = if controllers.is_empty() {
            ("sys/fs/cgroup", 2)
        } else if controllers.split(',').any(|controller| controller == "memory") {
            ("sys/fs/cgroup/memory", 1)
        } else {
            continue;
        };
        let path = Path::new(path.trim_start_matches('/'));
        let folders = path.ancestors().map(|path| root.join(mounted).join(path));
        groups.extend(folders.map(|folder| ControlGroup { folder, version }));
    }
    groups
}

impl ControlGroup {
    /// The number in a file, which has one name in version 1 and another name in version 2; `max` is not a number.
    fn number(&self, names: [&str; 2]) -> Option<u64> {
        let text = fs::read_to_string(self.folder.join(names[self.version - 1])).ok()?;
        text.trim().parse().ok()
    }

    fn limit(&self) -> Option<u64> {
        self.number(["memory.limit_in_bytes", "memory.max"])
    }

    /// The additional swap space of the group, if it is limited.
    fn swap(&self, limit: u64) -> Option<u64> {
        let stated = self.number(["memory.memsw.limit_in_bytes", "memory.swap.max"])?;
        Some(if self.version == 1 { stated.saturating_sub(limit) } else { stated })
    }

    /// The used memory, without copies of files that can be read again.
    fn used(&self) -> u64 {
        let used = self.number(["memory.usage_in_bytes", "memory.current"]).unwrap_or(0);
        let stat = Fields(fs::read_to_string(self.folder.join("memory.stat")).unwrap_or_default());
        let copies = ["total_inactive_file", "inactive_file"][self.version - 1];
        used.saturating_sub(stat.number(copies).unwrap_or(0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The memory of a system with these files.
    fn memory(files: &[(&str, &str)]) -> Memory {
        let root = tempfile::tempdir().unwrap();
        let write = |(name, text): &(&str, &str)| {
            let path = root.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        };
        files.iter().for_each(write);
        Memory::read(root.path())
    }

    const INFO: (&str, &str) = (
        "proc/meminfo",
        "MemTotal:  8388608 kB\nMemFree:  100 kB\nMemAvailable:  4194304 kB\nSwapTotal:  1048576 kB\n",
    );
    const GIB: u64 = 1 << 30;

    fn of(most: u64, free: u64) -> Memory {
        Memory { most: Some(most), free: Some(free), own: 0 }
    }

    #[test]
    fn without_limits_the_machine_s_memory_counts() {
        assert_eq!(memory(&[]), Memory::default());
        assert_eq!(memory(&[INFO]), of(9 * GIB, 4 * GIB));
        let status = ("proc/self/status", "Name:\tbothways\nVmRSS:\t 1048576 kB\n");
        assert_eq!(memory(&[INFO, status]), Memory { own: GIB, ..of(8 * GIB, 4 * GIB) });
    }

    #[test]
    fn a_control_group_of_version_2_limits_it() {
        let in_group = ("proc/self/cgroup", "0::/user.slice/run.scope\n");
        let limits = [
            INFO,
            in_group,
            ("sys/fs/cgroup/user.slice/run.scope/memory.max", "max\n"),
            ("sys/fs/cgroup/user.slice/memory.max", "2147483648\n"),
            ("sys/fs/cgroup/user.slice/memory.current", "1610612736\n"),
            ("sys/fs/cgroup/user.slice/memory.stat", "anon 7\ninactive_file 536870912\n"),
            ("sys/fs/cgroup/user.slice/memory.swap.max", "0\n"),
        ];
        assert_eq!(memory(&limits), of(2 * GIB, GIB));
        // Without a limit on swap space, all swap space counts.
        assert_eq!(memory(&limits[..6]).most, Some(3 * GIB));
        let unlimited = of(9 * GIB, 4 * GIB);
        assert_eq!(memory(&limits[..3]), unlimited);
    }

    #[test]
    fn a_control_group_of_version_1_limits_it() {
        let limits = [
            INFO,
            ("proc/self/cgroup", "5:cpu,cpuacct:/x\n4:memory:/docker/abc\n0::/\n"),
            // A container sees its own group as the root.
            ("sys/fs/cgroup/memory/memory.limit_in_bytes", "1073741824\n"),
            ("sys/fs/cgroup/memory/memory.memsw.limit_in_bytes", "1610612736\n"),
            ("sys/fs/cgroup/memory/memory.usage_in_bytes", "805306368\n"),
            (
                "sys/fs/cgroup/memory/memory.stat",
                "inactive_file 1\ntotal_inactive_file 268435456\n",
            ),
        ];
        assert_eq!(memory(&limits), of(3 * GIB / 2, GIB / 2));
    }
}
