//! The program at a terminal: a progress bar that disappears completely, and Ctrl-C.
#![cfg(target_os = "linux")]
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{Winsize, tcsetwinsize};
use std::fs::{self, File};
use std::io::{BufRead, Read};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Long enough for the bar to appear, and short enough to wait for.
const SLOW: [&str; 6] = ["many", "--method", "textbook", "--size", "8x6", "--no-times"];

/// The program shows no bar before a task has taken this long.
const PATIENCE: Duration = Duration::from_millis(400);

/// A pseudo terminal, 90 characters wide: the user reads it, and the program writes to it.
fn terminal() -> (File, File) {
    let person = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
    grantpt(&person).unwrap();
    unlockpt(&person).unwrap();
    let size = Winsize { ws_row: 24, ws_col: 90, ws_xpixel: 0, ws_ypixel: 0 };
    tcsetwinsize(&person, size).unwrap();
    let name = ptsname(&person, Vec::new()).unwrap().into_string().unwrap();
    let program = fs::OpenOptions::new().read(true).write(true).open(name).unwrap();
    (person.into(), program)
}

fn bothways(home: &TempDir, args: &[&str]) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin("bothways"));
    command.current_dir(home).args(args).env("TERM", "xterm").env_remove("NO_COLOR");
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// The text on the terminal that is the program's stderr; the program's stdout is a pipe.
fn seen_on_stderr(mut command: Command) -> String {
    let (mut person, program) = terminal();
    let child = command.stderr(program).spawn().unwrap();
    // The program's end closes with the program, but also with what was made to start it.
    drop(command);
    let mut seen = Vec::new();
    // A terminal without any remaining writer reads as an error.
    let mut piece = [0; 4096];
    while let Ok(count @ 1..) = person.read(&mut piece) {
        seen.extend_from_slice(&piece[..count]);
    }
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success() && !output.stdout.contains(&0x1b));
    String::from_utf8(seen).unwrap()
}

#[test]
fn a_long_rendering_shows_how_far_it_is_and_erases_that() {
    let home = tempfile::tempdir().unwrap();
    // Each order alone is slow enough for a bar, on a quick machine too.
    let slower = SLOW.map(|arg| if arg == "8x6" { "16x12" } else { arg });
    let seen = seen_on_stderr(bothways(&home, &slower));
    assert!(seen.contains("object order [") && seen.contains("image order  ["), "{seen:?}");
    assert!(seen.contains(" %, ") && seen.contains(" s left"), "{seen:?}");
    // The output is a single line, redrawn several times, and erased at the end; no colours.
    assert!(seen.ends_with("\r\u{1b}[2K") && !seen.contains('\n'), "{seen:?}");
    assert!(seen.split('\u{1b}').skip(1).all(|rest| rest.starts_with("[2K")), "{seen:?}");
}

/// The text on the terminal of a run that was shorter than the program waits before it shows a bar. On a busy machine,
/// several runs are needed to get one.
fn seen_of_a_quick_run(home: &TempDir) -> String {
    let begun = Instant::now();
    loop {
        let run = Instant::now();
        let seen = seen_on_stderr(bothways(home, &["canonical", "--size", "4x4"]));
        if run.elapsed() < PATIENCE {
            return seen;
        }
        assert!(begun.elapsed() < Duration::from_secs(60), "no run is quick");
    }
}

#[test]
fn quick_runs_quiet_runs_dumb_terminals_and_pipes_get_no_bar() {
    let home = tempfile::tempdir().unwrap();
    assert_eq!(seen_of_a_quick_run(&home), "");
    let quiet = [&SLOW[..], &["--quiet"]].concat();
    assert_eq!(seen_on_stderr(bothways(&home, &quiet)), "");
    let mut dumb = bothways(&home, &SLOW);
    dumb.env("TERM", "dumb");
    assert_eq!(seen_on_stderr(dumb), "");
    let piped = bothways(&home, &SLOW).output().unwrap();
    assert_eq!(String::from_utf8(piped.stderr).unwrap(), "");
}

/// The first text on stderr, as soon as it appears.
fn first_line(child: &mut Child) -> String {
    let mut line = String::new();
    std::io::BufReader::new(child.stderr.take().unwrap()).read_line(&mut line).unwrap();
    line
}

#[test]
fn a_run_that_takes_much_memory_says_so_before_it_takes_it() {
    let home = tempfile::tempdir().unwrap();
    // 3840 · 2160 · 6² samples of 8 bytes in two orders, and 18 bytes a pixel: 5.0 GB.
    let large = ["canonical", "--size", "3840x2160", "--viewport", "16,9", "--samples", "6"];
    let mut child = bothways(&home, &large).spawn().unwrap();
    let line = first_line(&mut child);
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(line.contains("298,598,400 samples "), "{line}");
    // The text with enough memory, or without.
    assert!(line.contains(" take 4.6 GiB of memory; ") || line.contains(" need at least 4.6 GiB "));
    assert!(line.contains("--crop") && line.contains("fewer --samples"), "{line}");
}

#[test]
fn a_run_of_more_than_a_minute_says_so_in_one_line_and_how_to_make_it_shorter() {
    let home = tempfile::tempdir().unwrap();
    let long = ["many", "--method", "textbook", "--size", "400x250", "--samples", "4"];
    let mut child = bothways(&home, &long).spawn().unwrap();
    let line = first_line(&mut child);
    press_ctrl_c(&child);
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let rest = ", as the textbook tests every primitive at every sample: --method fast gives the same \
                answers far sooner, a smaller --size, a --crop of it or fewer --samples shorten it \
                too\n";
    let time = line.strip_prefix("note: this takes about ").unwrap().strip_suffix(rest).unwrap();
    let (number, unit) = time.split_once(' ').unwrap();
    assert!(number.parse::<u32>().unwrap() > 1 && ["min", "h", "days"].contains(&unit), "{line}");
}

/// Runs until the output folder contains a file, and then presses Ctrl-C.
fn interrupted(home: &TempDir, args: &[&str]) -> Child {
    let child = bothways(home, args).spawn().unwrap();
    let begun = Instant::now();
    let hidden = |entry: fs::DirEntry| entry.file_name().to_string_lossy().starts_with(".bothways");
    // A new folder, and an existing folder.
    let begun_in = |folder: &str| {
        let entries = fs::read_dir(home.path().join(folder));
        entries.is_ok_and(|mut entries| entries.any(|one| hidden(one.unwrap())))
    };
    while !begun_in("out") && !begun_in("out/many") {
        assert!(begun.elapsed() < Duration::from_secs(20), "it does not begin");
    }
    press_ctrl_c(&child);
    child
}

#[test]
fn an_interrupted_rendering_leaves_nothing_behind() {
    let home = tempfile::tempdir().unwrap();
    let endless = ["many", "--method", "textbook"];
    let output = interrupted(&home, &endless).wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    assert_eq!(String::from_utf8(output.stderr).unwrap(), "\ninterrupted: nothing was written\n");
    assert!(!home.path().join("out").exists());

    // The earlier files stay.
    let report = home.path().join("out/many/report.json");
    fs::create_dir_all(report.parent().unwrap()).unwrap();
    fs::write(&report, "old").unwrap();
    interrupted(&home, &endless).wait().unwrap();
    let left: Vec<_> = fs::read_dir(report.parent().unwrap()).unwrap().collect();
    assert_eq!((left.len(), fs::read_to_string(&report).unwrap().as_str()), (1, "old"));
}

#[test]
fn a_sweep_ends_at_once_and_keeps_what_it_measured() {
    let home = tempfile::tempdir().unwrap();
    let sweep = ["sweep", "triangles", "--most", "10M", "--rounds", "100", "-o", "out"];
    let mut child = bothways(&home, &sweep).spawn().unwrap();
    let csv = home.path().join("out/sweep.csv");
    let measured = || fs::read_to_string(&csv).map_or(0, |text| text.lines().count());
    while measured() < 4 {
        assert_eq!(child.try_wait().unwrap(), None, "it ends before it is interrupted");
        std::thread::sleep(Duration::from_millis(5));
    }
    press_ctrl_c(&child);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    let said = String::from_utf8(output.stderr).unwrap();
    let csv_said = Path::new("out").join("sweep.csv");
    assert_eq!(said, format!("\ninterrupted: what was measured stays in {}\n", csv_said.display()));
    assert!(measured() >= 4);
}

fn press_ctrl_c(child: &Child) {
    let id = rustix::process::Pid::from_child(child);
    rustix::process::kill_process(id, rustix::process::Signal::INT).unwrap();
}

/// The content of a folder: the width of a picture in it, whether there is a report, and nothing else.
fn width_in(folder: &Path) -> (u32, usize) {
    let (width, _) = image::image_dimensions(folder.join("object-order.png")).unwrap();
    let report = fs::read_to_string(folder.join("report.json")).unwrap();
    assert!(report.contains(&format!("\"size\": [\n    {width},")), "{width}: {report}");
    (width, fs::read_dir(folder).unwrap().count())
}

#[test]
fn the_exit_code_of_an_interrupted_run_tells_what_is_in_the_folder() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path().join("out");
    let run = |width: &str| {
        let size = format!("{width}x8");
        bothways(&home, &["canonical", "--size", &size, "--quiet", "-o", "out"]).spawn().unwrap()
    };
    let begun = Instant::now();
    assert!(run("4").wait().unwrap().success());
    let usual = begun.elapsed();
    let mut codes = Vec::new();
    for (round, width) in (5..45).enumerate() {
        let (before, child) = (width_in(&folder), run(&width.to_string()));
        // From the middle to the end, where files are moved.
        std::thread::sleep(usual * (20 + u32::try_from(round).unwrap()) / 40);
        press_ctrl_c(&child);
        let output = child.wait_with_output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        match output.status.code() {
            Some(0) => assert_eq!((width_in(&folder), said.as_str()), ((width, 7), "")),
            Some(130) => {
                assert_eq!(width_in(&folder), before, "{said}");
                assert!(["", "\ninterrupted: nothing was written\n"].contains(&&*said), "{said}");
            }
            // The signal came before the program began.
            None => assert_eq!(width_in(&folder), before),
            code => panic!("{code:?}: {said}"),
        }
        codes.push(output.status.code());
    }
    println!("{codes:?}");
}

#[test]
fn a_run_that_waits_for_another_can_be_interrupted() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path().join("out");
    let run = |size| bothways(&home, &["canonical", "--size", size, "-o", "out"]).spawn().unwrap();
    assert!(run("4x8").wait().unwrap().success());
    // The same state as a run that moves its files.
    let other = File::open(&folder).unwrap();
    other.lock().unwrap();
    let written = || {
        let hidden = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path());
        hidden.filter(|path| path.is_dir()).any(|path| path.join("new/report.json").exists())
    };
    let wait = |child: &mut Child| {
        while !written() {
            std::thread::sleep(Duration::from_millis(5));
        }
        std::thread::sleep(Duration::from_millis(100));
        assert_eq!(child.try_wait().unwrap(), None);
    };
    let mut child = run("5x8");
    wait(&mut child);
    press_ctrl_c(&child);
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(width_in(&folder), (4, 7));

    let mut child = run("6x8");
    wait(&mut child);
    other.unlock().unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(0));
    assert_eq!(width_in(&folder), (6, 7));
}

#[test]
fn ctrl_c_ends_fuzzing_with_the_summary_of_what_was_done() {
    let home = tempfile::tempdir().unwrap();
    let args = ["fuzz", "--seconds", "3600", "--threads", "1", "--seed", "5"];
    let child = bothways(&home, &args).spawn().unwrap();
    // Long enough for the program to begin; the scenes take far longer.
    std::thread::sleep(Duration::from_secs(1));
    press_ctrl_c(&child);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    assert_eq!(String::from_utf8(output.stderr).unwrap(), "");
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains(" pixels, ") && text.contains(", 0 disagreements\n"), "{text}");
    assert!(text.ends_with("; seed 5; ended by Ctrl-C\n"), "{text}");
}

#[test]
fn fuzzing_shows_how_far_it_is_and_erases_that() {
    let home = tempfile::tempdir().unwrap();
    let seen = seen_on_stderr(bothways(&home, &["fuzz", "--scenes", "4", "--seed", "5"]));
    assert!(seen.contains(" pixels, ") && seen.ends_with("\r\u{1b}[2K"), "{seen:?}");
}
