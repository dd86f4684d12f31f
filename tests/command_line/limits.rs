//! What is left when a run is stopped, or when memory or the disk ends: all files of the old run or all of the new one,
//! a message and an exit code, and never a signal.

#![cfg(target_os = "linux")]
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::folder::names;
use rustix::process::{Pid, Signal, kill_process};
use std::collections::BTreeMap;
use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Command, ExitStatus, Output, Stdio};
use std::thread;
use std::time::Instant;
use tempfile::TempDir;

/// The exit code of a run that a signal asked to end.
const INTERRUPTED: i32 = 130;

fn home() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// `bothways` with two threads, in a folder.
fn bothways(home: &Path, line: &str) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin("bothways"));
    command.current_dir(home).args(line.split_whitespace());
    command.env("RAYON_NUM_THREADS", "2").env_remove("RUST_BACKTRACE").stdin(Stdio::null());
    command
}

/// The same, started by a shell after these commands of it.
fn limited(home: &Path, limit: &str, line: &str) -> Output {
    let mut command = Command::new("sh");
    let script = format!("ulimit -c 0; {limit}; exec \"$0\" \"$@\"");
    command.args(["-c", &script]).arg(assert_cmd::cargo::cargo_bin("bothways"));
    command.args(line.split_whitespace()).current_dir(home);
    command.env("RAYON_NUM_THREADS", "2").env_remove("RUST_BACKTRACE").output().unwrap()
}

/// The files below a folder, each with its content.
fn content(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = BTreeMap::new();
    for name in names(folder) {
        let path = folder.join(&name);
        if path.is_dir() {
            let inside = content(&path).into_iter();
            all.extend(inside.map(|(file, bytes)| (format!("{name}/{file}"), bytes)));
        } else {
            all.insert(name, fs::read(path).unwrap());
        }
    }
    all
}

/// What a line of commands writes into an empty folder.
fn written(line: &str) -> BTreeMap<String, Vec<u8>> {
    let home = home();
    let status = bothways(home.path(), line).stdout(Stdio::null()).stderr(Stdio::null()).status();
    assert!(status.unwrap().success(), "{line}");
    content(home.path())
}

/// Runs that write over one another's files: each line, and how it is written with two different contents.
const RUNS: [[&str; 2]; 3] = [
    [
        "canonical --size 6x6 --no-times --quiet -o there",
        "canonical --size 9x6 --no-times --quiet -o there --buffers npy",
    ],
    [
        "film canonical --size 6x6 --seconds 0.2 --pause 0 --width 480 -o f.gif",
        "film canonical --size 9x9 --seconds 0.2 --pause 0 --width 480 -o f.gif",
    ],
    [
        "export canonical --as mitsuba -o scene",
        "export canonical --as mitsuba --eye 0,0,1 -o scene",
    ],
];

/// Asserts that a folder has all files of one of the runs, or none, and nothing hidden; returns what it has.
fn whole(
    home: &Path,
    of_either: &[BTreeMap<String, Vec<u8>>; 2],
    case: &str,
) -> BTreeMap<String, Vec<u8>> {
    let found = content(home);
    let is_whole = found.is_empty() || of_either.contains(&found);
    assert!(is_whole, "{case}: {:?}", found.keys().collect::<Vec<_>>());
    found
}

#[test]
fn sigterm_at_any_moment_leaves_all_old_or_all_new_files() {
    let mut random = fastrand::Rng::with_seed(21);
    for lines in RUNS {
        let (home, of_either) = (home(), lines.map(written));
        let begun = Instant::now();
        assert!(bothways(home.path(), lines[0]).output().unwrap().status.success());
        let usual = begun.elapsed();
        let mut before = content(home.path());
        for round in 0..14 {
            let line = lines[1 - round % 2];
            let mut command = bothways(home.path(), line);
            let mut run = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
            // More often towards the end, where the files are moved.
            thread::sleep(usual.mul_f64(1.2 * random.f64().sqrt()));
            // A run that has ended takes no signal.
            let _ = kill_process(Pid::from_child(&run), Signal::TERM);
            let status = run.wait().unwrap();
            let found = whole(home.path(), &of_either, &format!("{line}: {status}"));
            match ended(status) {
                Ended::Whole => assert_eq!(found, of_either[1 - round % 2], "{line}"),
                // The signal came before the program could take it, or it was taken.
                Ended::Asked => assert!(found == before, "{line}"),
            }
            before = found;
        }
    }
}

/// How a run ended that was sent a signal.
#[derive(Debug)]
enum Ended {
    Whole,
    Asked,
}

fn ended(status: ExitStatus) -> Ended {
    match (status.code(), status.signal()) {
        (Some(0), None) => Ended::Whole,
        (Some(INTERRUPTED), None) => Ended::Asked,
        (None, Some(signal)) if signal == Signal::TERM.as_raw() => Ended::Asked,
        other => panic!("{other:?}"),
    }
}

/// Asserts that a run in want of something ends with its files, or with one message and without them.
fn assert_told(output: &Output, case: &str) -> bool {
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.signal(), None, "{case}: {stderr}");
    let code = output.status.code().unwrap();
    assert!(!stderr.contains("panicked"), "{case}: {stderr}");
    match code {
        0 => true,
        2 => {
            let says = |line: &str| line.starts_with("error: ");
            assert!(stderr.lines().any(says) && stderr.len() < 1000, "{case}: {stderr}");
            false
        }
        _ => panic!("{case}: exit code {code}: {stderr}"),
    }
}

#[test]
fn a_file_that_may_not_grow_leaves_all_old_files() {
    for lines in RUNS {
        let of_either = lines.map(written);
        let largest = of_either[1].values().map(Vec::len).max().unwrap();
        let (home, mut failed) = (home(), 0);
        assert!(bothways(home.path(), lines[0]).output().unwrap().status.success());
        // Blocks of 512 bytes in some shells, and of 1024 in others.
        let blocks = [0, 1, largest / 4096, largest / 2048, largest / 512 + 1];
        for blocks in blocks {
            let limit = format!("trap '' XFSZ; ulimit -f {blocks}");
            let output = limited(home.path(), &limit, lines[1]);
            let case = format!("{} with {blocks} blocks", lines[1]);
            let is_new = assert_told(&output, &case);
            let found = whole(home.path(), &of_either, &case);
            assert_eq!(found, of_either[usize::from(is_new)], "{case}");
            failed += usize::from(!is_new);
            if is_new {
                break;
            }
        }
        assert!((1..blocks.len()).contains(&failed), "{}: {failed}", lines[1]);
    }
}

/// A disk of so many KiB, if this user may make one: a file system in memory, within a world of its own.
fn on_small_disk(home: &Path, kibibytes: usize, lines: &[&str; 2]) -> Option<Output> {
    let program = assert_cmd::cargo::cargo_bin("bothways");
    let script = format!(
        "mount -t tmpfs -o size={kibibytes}k none small && cd small && \"$0\" {} && cp -a . ../before && \
         {{ \"$0\" {}; code=$?; cp -a . ../after; exit $code; }}",
        lines[0], lines[1]
    );
    fs::create_dir(home.join("small")).unwrap();
    let can_mount = Command::new("unshare")
        .args(["--user", "--map-root-user", "--mount", "mount", "-t", "tmpfs", "none", "small"])
        .current_dir(home)
        .output();
    if !can_mount.is_ok_and(|output| output.status.success()) {
        return None;
    }
    let mut command = Command::new("unshare");
    command.args(["--user", "--map-root-user", "--mount", "sh", "-c", &script]).arg(program);
    Some(command.current_dir(home).env("RAYON_NUM_THREADS", "2").output().unwrap())
}

#[test]
fn a_full_disk_leaves_all_old_files() {
    // The slide alone has some hundred KiB: there is room for it once.
    let lines = [RUNS[0][0], RUNS[0][1]];
    let size: usize =
        written(lines[0]).values().map(|bytes| bytes.len().next_multiple_of(4096)).sum();
    let home = home();
    let Some(output) = on_small_disk(home.path(), size / 1024 + 60, &lines) else {
        println!("skipped, this user may mount nothing");
        return;
    };
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    assert!(stderr.contains("no space is left on the device; free some, or"), "{stderr}");
    let (before, after) =
        (content(&home.path().join("before")), content(&home.path().join("after")));
    assert!(before.contains_key("there/report.json"));
    assert!(before == after, "{:?}", after.keys().collect::<Vec<_>>());
}

/// A mesh of many vertices that takes far more memory than a run by itself.
fn large_mesh(home: &Path) {
    let status = bothways(home, "mesh sphere --divisions 800,400 -o large.ply").output().unwrap();
    assert!(status.status.success(), "{}", String::from_utf8_lossy(&status.stderr));
}

#[test]
fn little_memory_ends_with_a_message_or_with_all_files() {
    let home = home();
    large_mesh(home.path());
    let lines = ["large.ply --size 400x300 --no-times --quiet -o there", RUNS[1][0], RUNS[2][0]];
    for line in lines {
        let mut all = written_beside(home.path(), line);
        all.extend([("large.ply".to_owned(), fs::read(home.path().join("large.ply")).unwrap())]);
        let before = content(home.path());
        let (mut codes, mut explained) = ([0; 2], 0);
        for limit in memory_limits() {
            let output = match &limit {
                Limit::Addresses(kib) => limited(home.path(), &format!("ulimit -v {kib}"), line),
                Limit::Option(size) => {
                    limited(home.path(), "true", &format!("{line} --max-memory {size}"))
                }
            };
            let case = format!("{line} with {limit:?}");
            let is_new = assert_told(&output, &case);
            codes[usize::from(is_new)] += 1;
            explained += usize::from(is_explained(&output));
            if is_new {
                assert!(content(home.path()) == all, "{case}");
                remove_all_but(home.path(), &before);
            } else {
                // Memory may end at any line of the program: the next run removes what is hidden.
                let seen = visible(&content(home.path()));
                assert!(seen == before, "{case}: {:?}", seen.keys().collect::<Vec<_>>());
            }
        }
        assert!(codes[1] > 0, "{line}: {codes:?}");
        if line.starts_with("large") {
            assert!(codes[0] > 1 && explained > 1, "{line}: {codes:?}, {explained}");
        }
    }
}

/// Whether the standard library's message is followed by what to do.
fn is_explained(output: &Output) -> bool {
    let stderr = String::from_utf8_lossy(&output.stderr);
    let (first, last) = stderr.trim_end().rsplit_once('\n').unwrap_or_default();
    first.contains(" bytes failed")
        && last.starts_with("error: the run was aborted; if an allocation failed")
        && ["--max-memory", "--size", "--stream"].iter().all(|remedy| last.contains(remedy))
}

#[derive(Debug)]
enum Limit {
    /// The address space, in KiB.
    Addresses(u64),
    /// `--max-memory`.
    Option(&'static str),
}

fn memory_limits() -> impl Iterator<Item = Limit> {
    // From what the program itself takes on, with its libraries and threads.
    let addresses = [100_000, 160_000, 240_000, 400_000, 4_000_000].map(Limit::Addresses);
    let options = ["64M", "96M", "128M", "4G"].map(Limit::Option);
    addresses.into_iter().chain(options)
}

/// What a line of commands adds to a folder's files; they are removed again.
fn written_beside(home: &Path, line: &str) -> BTreeMap<String, Vec<u8>> {
    let before = content(home);
    assert!(bothways(home, line).output().unwrap().status.success(), "{line}");
    let all = content(home);
    remove_all_but(home, &before);
    all
}

/// The files without those in hidden folders.
fn visible(all: &BTreeMap<String, Vec<u8>>) -> BTreeMap<String, Vec<u8>> {
    let is_visible = |name: &str| !name.split('/').any(|part| part.starts_with(".bothways-"));
    all.iter().filter(|(name, _)| is_visible(name)).map(|(k, v)| (k.clone(), v.clone())).collect()
}

fn remove_all_but(home: &Path, kept: &BTreeMap<String, Vec<u8>>) {
    for name in names(home).into_iter().filter(|name| !kept.contains_key(name)) {
        let path = home.join(name);
        if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) }.unwrap();
    }
}

#[test]
fn max_memory_is_kept_to() {
    let home = home();
    let said = |line: &str| {
        let output = bothways(home.path(), line).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{line}");
        assert_eq!(names(home.path()), [""; 0], "{line}");
        String::from_utf8(output.stderr).unwrap()
    };
    // What is known is refused in advance.
    for line in [
        "canonical --size 4000x4000 --max-memory 200M -o there",
        "figure camera canonical --size 4000x4000 --max-memory 200M -o there.svg",
        "film canonical --size 4000x4000 --max-memory 200M -o there.gif",
    ] {
        let refused = said(line);
        let expected = "error: 16,000,000 samples need at least";
        assert!(refused.starts_with(expected), "{line}: {refused}");
        assert!(refused.contains("more than --max-memory leaves ("), "{line}: {refused}");
    }
    // The stacks of threads are memory.
    let threads = said("canonical --threads 1024 --max-memory 300M -o there");
    assert!(threads.starts_with("error: cannot start 1024 threads ("), "{threads}");
    let remedy = "give fewer with --threads, or allow more memory or more processes\n";
    assert!(threads.ends_with(remedy), "{threads}");
    // The same is drawn where it may take more.
    let drawn =
        bothways(home.path(), "canonical --size 400x400 --max-memory 1G --quiet -o there").status();
    assert!(drawn.unwrap().success());
    fs::remove_dir_all(home.path().join("there")).unwrap();
    // What is in a file is known while it is read.
    large_mesh(home.path());
    let output = bothways(home.path(), "large.ply --size 40x30 --max-memory 64M -o there").output();
    let output = output.unwrap();
    assert!(!assert_told(&output, "large.ply") && is_explained(&output), "{output:?}");
    assert_eq!(names(home.path()), ["large.ply"]);
}
