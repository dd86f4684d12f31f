//! Malicious files, and files of careless programs: every file ends in a readable message, in bounded time and
//! memory, and its text sends no control sequence to the terminal.
#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use assert_cmd::Command;
use std::fs::{self, File};
use std::os::unix::fs::symlink;
use std::path::Path;
use std::time::Duration;
use tempfile::TempDir;

/// Half of the largest file here: a reader of the whole file exceeds this limit.
const MOST_MEMORY_KIB: u64 = 4 << 20;

/// Runs the program in a folder, in limited memory and time.
fn bothways(home: &TempDir, args: &[&str]) -> (Option<i32>, String, String) {
    let mut command = Command::new("sh");
    let limited = format!("ulimit -c 0; ulimit -v {MOST_MEMORY_KIB}; exec \"$0\" \"$@\"");
    command.args(["-c", &limited, env!("CARGO_BIN_EXE_bothways")]).args(args);
    command.current_dir(home).env("RAYON_NUM_THREADS", "2").timeout(Duration::from_secs(60));
    let output = command.output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code(), text(output.stdout), text(output.stderr))
}

/// What is said about a file that is refused.
fn refusal(home: &TempDir, args: &[&str]) -> String {
    let (code, stdout, stderr) = bothways(home, args);
    assert_eq!((code, stdout.as_str()), (Some(2), ""), "{args:?}: {stderr}");
    assert!(!stderr.contains("panicked") && !stderr.contains("os error"), "{args:?}: {stderr}");
    assert!(stderr.len() < 2500, "{args:?}: {} bytes", stderr.len());
    stderr
}

fn write(home: &TempDir, name: &str, content: impl AsRef<[u8]>) {
    fs::write(home.path().join(name), content).unwrap();
}

const SPHERE: &str = "[[object]]\nsphere = { center = [0, 0, 0], radius = 1 }\n";

#[test]
fn an_error_far_to_the_right_is_shown_in_a_window() {
    let home = tempfile::tempdir().unwrap();
    for count in [3_000, 70_000] {
        let spheres = "{ sphere = { center = [0, 0, 0], radius = 1 } }, ".repeat(count / 50);
        write(&home, "line.toml", format!("object = [{spheres}{{ spere = 1 }}]\n"));
        let said = refusal(&home, &["line.toml"]);
        let column = "object = [".len() + spheres.len() + "{ ".len() + 1;
        assert!(said.contains(&format!("[line.toml:1:{column}]")), "{said}");
        assert!(said.contains("{ spere = 1 }]") && said.contains("─────"), "{said}");
        assert!(said.contains("did you mean \"sphere\"?"), "{said}");
    }
}

#[test]
fn messages_stay_short_whatever_a_file_quotes() {
    let home = tempfile::tempdir().unwrap();
    let long = "a".repeat(1_000_000);
    let materials: String = (0..20_000).map(|k| format!("[material.m{k}]\n")).collect();
    let scenes = [
        format!("{SPHERE}{long} = 1\n"),
        format!("{SPHERE}material = \"{long}\"\n"),
        format!("{SPHERE}material = \"{long}\"\n{materials}"),
        format!("{SPHERE}scale = {}\n", "1".repeat(1_000_000)),
        format!("{SPHERE}[camera]\nprojection = \"{long}\"\n"),
        format!("{SPHERE}[material.{long}]\ncolor = 1\n"),
        format!("[[object]]\nmesh = \"{long}\"\n"),
        format!("{SPHERE}x = [\n{}]\n", "1,\n".repeat(100_000)),
        format!("a = '{long}"),
    ];
    for scene in scenes {
        write(&home, "long.toml", scene);
        refusal(&home, &["long.toml"]);
    }
    write(&home, "long.toml", format!("{SPHERE}material = \"x\"\n{materials}"));
    let said = refusal(&home, &["long.toml"]);
    assert!(said.contains("m0, m1, m10, ") && said.contains(" and 19984 more"), "{said}");
}

#[test]
fn a_scene_file_has_a_largest_size() {
    let home = tempfile::tempdir().unwrap();
    write(&home, "large.toml", SPHERE.repeat(400_000));
    let said = refusal(&home, &["large.toml"]);
    assert!(said.contains("large.toml: a scene file of more than 8 MiB is not read"), "{said}");
    assert!(said.contains("mesh file"), "{said}");
}

#[test]
fn nested_brackets_of_an_array_take_no_time() {
    let home = tempfile::tempdir().unwrap();
    let descr = format!("{}'<u1'{}", "[".repeat(60), "]".repeat(60));
    let header = format!("{{'descr': {descr}, 'fortran_order': False, 'shape': (1, 1), }}\n");
    let length = u16::try_from(header.len()).unwrap().to_le_bytes();
    write(&home, "deep.npy", [b"\x93NUMPY\x01\x00", &length[..], header.as_bytes()].concat());
    let said = refusal(&home, &["diff", "deep.npy", "deep.npy"]);
    assert!(said.contains("too many parts; save an array of plain numbers"), "{said}");
}

#[test]
fn pipes_and_devices_are_refused_and_not_waited_for() {
    let home = tempfile::tempdir().unwrap();
    for name in ["zero.toml", "zero.obj", "zero.ply", "zero.png"] {
        symlink("/dev/zero", home.path().join(name)).unwrap();
    }
    for name in ["pipe.toml", "pipe.obj", "pipe.ply", "pipe.png"] {
        let made = std::process::Command::new("mkfifo").arg(home.path().join(name)).status();
        assert!(made.unwrap().success());
    }
    write(&home, "a.pgm", "P2 1 1 1\n1\n");
    for kind in ["zero", "pipe"] {
        for extension in ["toml", "obj", "ply"] {
            let name = format!("{kind}.{extension}");
            let said = refusal(&home, &[&name]);
            assert!(
                said.contains("a pipe or a device") && said.contains("as a file first"),
                "{said}"
            );
        }
        let name = format!("{kind}.png");
        let said = refusal(&home, &["diff", "a.pgm", &name]);
        assert!(said.contains("it is a pipe or a device; save it as a file first"), "{said}");
    }
    // A material file that is a device counts as missing.
    symlink("/dev/zero", home.path().join("zero.mtl")).unwrap();
    let obj = "mtllib zero.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
    write(&home, "a.obj", obj);
    let (code, _, stderr) = bothways(&home, &["a.obj", "--size", "8x8"]);
    assert_eq!(code, Some(0), "{stderr}");
    // A link to a device leads out of the folder.
    assert!(stderr.contains("the material file \"zero.mtl\" is outside of its folder"), "{stderr}");
}

/// A file of 8 GiB that takes no room on the disk.
fn sparse(path: &Path, start: &[u8]) {
    fs::write(path, start).unwrap();
    File::options().write(true).open(path).unwrap().set_len(8 << 30).unwrap();
}

#[test]
fn large_files_are_not_read_whole_to_be_refused() {
    let home = tempfile::tempdir().unwrap();
    let cases = [
        ("a.toml", "", "of more than 8 MiB is not read"),
        ("a.obj", "", "a.obj:1: this is not plain text"),
        ("b.obj", "v 0 0 0\n", "b.obj:2: this is not plain text"),
        ("a.ply", "", "begins with a line that says"),
    ];
    for (name, start, reason) in cases {
        sparse(&home.path().join(name), start.as_bytes());
        let said = refusal(&home, &[name]);
        assert!(said.contains(reason), "{said}");
    }
    sparse(&home.path().join("a.mtl"), b"newmtl a\n");
    write(&home, "c.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
    let said = refusal(&home, &["c.obj"]);
    assert!(said.contains("a.mtl:2: this is not plain text"), "{said}");
    write(&home, "a.pgm", "P2 1 1 1\n1\n");
    let starts: [&[u8]; 4] = [b"", b"\x89PNG\r\n\x1a\n", b"\x93NUMPY\x01\x00", b"P5 9 9 255\n"];
    for (k, start) in starts.iter().enumerate() {
        let name = format!("{k}.png");
        sparse(&home.path().join(&name), start);
        refusal(&home, &["diff", &name, "a.pgm"]);
    }
}

/// Characters that clear a screen, set a title, change colours and reverse the direction of text.
const ESCAPES: &str = "\u{1b}[2J\u{1b}]0;title\u{7}\u{9b}31m\u{202e}\u{2066}";

/// Asserts that a text has escapes in place of the characters that control a terminal.
fn assert_escaped(text: &str) {
    let obeyed = |c: char| {
        (c.is_control() && c != '\n')
            || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    assert!(!text.contains(obeyed), "{text:?}");
    assert!(text.contains("\\u{"), "{text:?}");
}

#[test]
fn no_text_of_a_file_controls_the_terminal() {
    let home = tempfile::tempdir().unwrap();
    let soft = "\u{9b}31m\u{202e}";
    let scenes = [
        format!("{SPHERE}# {soft}\nspere = 1 # {soft}\n"),
        format!("{SPHERE}\"{soft}\" = 1\n"),
        format!("{SPHERE}material = \"{soft}\"\n"),
        format!("[material.\"{soft}\"]\ncolor = 1\n{SPHERE}"),
        format!("{SPHERE}# {ESCAPES}\n"),
        format!("[[object]]\nmesh = \"{soft}.obj\"\n"),
    ];
    for scene in scenes {
        write(&home, "a.toml", scene);
        assert_escaped(&refusal(&home, &["a.toml"]));
    }
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    write(&home, "a.obj", format!("{triangle}v 1 {ESCAPES}\n"));
    assert_escaped(&refusal(&home, &["a.obj"]));
    let header = format!("ply\nformat ascii 1.0\nelement {soft} 1\n");
    write(&home, "a.ply", format!("{header}element vertex 1\nend_header\n"));
    assert_escaped(&refusal(&home, &["a.ply"]));
    let header = format!("{{'descr': '{soft}', 'fortran_order': False, 'shape': (1, 1), }}\n");
    let length = u16::try_from(header.len()).unwrap().to_le_bytes();
    write(&home, "a.npy", [b"\x93NUMPY\x03\x00", &length[..], &[0, 0], header.as_bytes()].concat());
    assert_escaped(&refusal(&home, &["diff", "a.npy", "a.npy"]));

    // Names of files, and of undefined materials.
    let name = format!("{ESCAPES}.obj");
    write(&home, &name, format!("usemtl {ESCAPES}\n{triangle}"));
    let (code, _, stderr) = bothways(&home, &[&name, "--size", "8x8", "-o", "out"]);
    assert_eq!(code, Some(0), "{stderr}");
    assert_escaped(&stderr);
    for missing in [format!("{ESCAPES}-.toml"), format!("{ESCAPES}-.obj"), ESCAPES.to_owned()] {
        assert_escaped(&refusal(&home, &[&missing]));
    }
    let name = format!("{ESCAPES}.pgm");
    write(&home, &name, "P2 1 1 1\n1\n");
    let (code, stdout, _) = bothways(&home, &["diff", &name, &name]);
    assert_eq!(code, Some(0));
    assert_escaped(&stdout);
}
