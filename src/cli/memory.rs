//! The memory that a run needs, compared with the available memory before the work begins.

use super::args::{BuffersArg, RenderArgs};
use super::failure::Failure;
use super::terminal;
use bothways::common::Camera;
use bothways::wording::count;
use std::fs;
use std::path::{Path, PathBuf};

/// The bytes of a sample in a frame: id and distance.
const BYTES_PER_SAMPLE: u64 = 4 + 4;
/// The additional bytes of a sample in a stream: id and distance of the earlier chunks, and the triangle's three
/// vertices.
const BYTES_PER_STREAMED_SAMPLE: u64 = 4 + 4 + 12;
/// The additional bytes of a sample in object order with the rules of an ordinary renderer: the depth buffer.
const BYTES_PER_RULED_SAMPLE: u64 = 8;
/// The additional bytes of a sample for `--buffers exr`: a linear colour, a normal, and its work as it is stored.
const BYTES_PER_EXR_SAMPLE: u64 = 12 + 12 + 4;
/// The bytes of a sample while its work is counted, in one order at a time.
const BYTES_PER_COUNTED_SAMPLE: u64 = 8 + 8;
/// The bytes of a pixel in the frames' pictures, and while pictures are drawn, compared and compressed: of one order, or
/// of both at once (measured with 3000 × 3000 pixels without the frames: 12).
const BYTES_PER_PIXEL: [u64; 2] = [3 + 8, 6 + 12];
/// The bytes for the program itself, and a slide of 1920 × 1080. The prepared data of an order (clusters, a
/// hierarchy) and the data that it keeps from frame to frame (projected vertices, bins) are not counted: their size
/// depends on the scene, and is small compared with a frame that is refused for its size.
const BYTES_FOR_THE_REST: u64 = 32 << 20;

/// From this number of bytes on, a run reports its memory in advance.
const MUCH: u64 = 4 << 30;

/// Refuses a run that does not fit into memory; warns about a run that needs much of the memory, or more than the
/// free memory.
pub(super) fn check(camera: &Camera, args: &RenderArgs) -> Result<(), Failure> {
    let need = Need::of(camera, args);
    let memory = Memory::read(Path::new("/"));
    if memory.most.is_some_and(|most| need.bytes > most) || !can_be_reserved(need.bytes) {
        return Err(Failure::new(need.refusal(memory.most)));
    }
    if !args.output.quiet {
        terminal::warn(&need.warning(memory.free).into_iter().collect::<Vec<_>>());
        if need.bytes >= MUCH && memory.free.is_none_or(|free| need.bytes <= free) {
            anstream::eprintln!("note: {} take less", need.takes());
        }
    }
    Ok(())
}

/// The memory of all frames and pictures of a run.
#[derive(Debug)]
struct Need {
    samples: u64,
    bytes: u64,
}

impl Need {
    fn of(camera: &Camera, args: &RenderArgs) -> Need {
        let options = args.method.options();
        let pixels = options.pixels(camera.image());
        let samples = pixels.region(options.samples).area() as u64;
        let pixels = u64::from(pixels.width) * u64::from(pixels.height);
        let orders = args.method.order.orders().len();
        let streamed = if args.method.stream { BYTES_PER_STREAMED_SAMPLE } else { 0 };
        let ruled =
            if args.method.rules().object_order.is_some() { BYTES_PER_RULED_SAMPLE } else { 0 };
        let exr = args.output.buffers == BuffersArg::Exr;
        let (kept, counted) =
            if exr { (BYTES_PER_EXR_SAMPLE, BYTES_PER_COUNTED_SAMPLE) } else { (0, 0) };
        let bytes = samples * orders as u64 * (BYTES_PER_SAMPLE + streamed + kept)
            + samples * (ruled + counted)
            + pixels * BYTES_PER_PIXEL[orders - 1]
            + BYTES_FOR_THE_REST;
        Need { samples, bytes }
    }

    /// The message is complete even if the limit of memory is unknown.
    fn refusal(&self, most: Option<u64>) -> String {
        let (samples, need) = (count(self.samples, "samples"), gibibytes(self.bytes));
        // If a program may have less memory than the machine has, a limit applies (`ulimit -v`).
        let than = match most.filter(|&most| self.bytes > most) {
            Some(most) => format!("than there is ({})", gibibytes(most)),
            None => "than this program may have".into(),
        };
        format!(
            "{samples} need at least {need} of memory, more {than}; take a smaller --size, a --crop of it, \
             fewer --samples, or one --order alone"
        )
    }

    /// The warning that the run may not fit, if this is possible.
    fn warning(&self, free: Option<u64>) -> Option<String> {
        let free = free.filter(|&free| self.bytes > free)?;
        let free = gibibytes(free);
        Some(format!(
            "only {free} are free, so the system may stop this run or grow slow: {} take less",
            self.takes()
        ))
    }

    fn takes(&self) -> String {
        let (samples, bytes) = (count(self.samples, "samples"), gibibytes(self.bytes));
        format!(
            "{samples} take {bytes} of memory; a smaller --size, a --crop of it, fewer --samples, or \
             one --order alone"
        )
    }
}

/// The number of gibibytes, rounded to a tenth.
fn gibibytes(bytes: u64) -> String {
    let tenths = (u128::from(bytes) * 10 + (1 << 29)) >> 30;
    format!("{}.{} GiB", tenths / 10, tenths % 10)
}

/// Whether the system can reserve this much memory at once, where addresses are limited: the system might grant one
/// frame after another, and then fail to provide the memory.
fn can_be_reserved(bytes: u64) -> bool {
    let mut all = Vec::<u8>::new();
    let fits = usize::try_from(bytes).is_ok_and(|bytes| all.try_reserve_exact(bytes).is_ok());
    // The result is used, so that the compiler does not remove the allocation.
    std::hint::black_box(&mut all);
    fits
}

/// The available memory, as reported by the system.
#[derive(Debug, Default, PartialEq, Eq)]
struct Memory {
    /// The most bytes that this program can get in addition to its present memory, with all swap space.
    most: Option<u64>,
    /// The bytes that the program can get without swapping.
    free: Option<u64>,
}

impl Memory {
    /// Reads the files of the Linux kernel below `root`. On other systems the memory is unknown.
    fn read(root: &Path) -> Memory {
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
        // The scene is already in memory at this point.
        let own = kibibytes(&own, "VmRSS:").unwrap_or(0);
        Memory { most: most.map(|most| most.saturating_sub(own)), free }
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

    #[test]
    fn without_limits_the_machine_s_memory_counts() {
        assert_eq!(memory(&[]), Memory::default());
        assert_eq!(memory(&[INFO]), Memory { most: Some(9 * GIB), free: Some(4 * GIB) });
        let status = ("proc/self/status", "Name:\tbothways\nVmRSS:\t 1048576 kB\n");
        assert_eq!(memory(&[INFO, status]), Memory { most: Some(8 * GIB), free: Some(4 * GIB) });
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
        assert_eq!(memory(&limits), Memory { most: Some(2 * GIB), free: Some(GIB) });
        // Without a limit on swap space, all swap space counts.
        assert_eq!(memory(&limits[..6]).most, Some(3 * GIB));
        let unlimited = Memory { most: Some(9 * GIB), free: Some(4 * GIB) };
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
        assert_eq!(memory(&limits), Memory { most: Some(3 * GIB / 2), free: Some(GIB / 2) });
    }

    #[test]
    fn what_is_said_has_numbers_and_remedies() {
        let need = Need { samples: 132_710_400, bytes: 8_600_000_000 };
        assert_eq!(
            need.refusal(Some(2 * GIB)),
            "132,710,400 samples need at least 8.0 GiB of memory, more than there is (2.0 GiB); take a \
             smaller --size, a --crop of it, fewer --samples, or one --order alone"
        );
        // The memory of the machine is enough, but a limit is too low.
        assert!(need.refusal(Some(20 * GIB)).contains(", more than this program may have; take"));
        assert_eq!(need.warning(Some(9 * GIB)), None);
        assert_eq!(
            need.warning(Some(GIB)).unwrap(),
            "only 1.0 GiB are free, so the system may stop this run or grow slow: 132,710,400 samples \
             take 8.0 GiB of memory; a smaller --size, a --crop of it, fewer --samples, or one --order \
             alone take less"
        );
    }
}
