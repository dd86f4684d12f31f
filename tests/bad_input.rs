//! Whatever is wrong on the command line is named: what is said of every bad value of every option.
//!
//! A message is one that a reader can act on: it names the value, and says what would be right.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod support;

use assert_cmd::Command;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use support::arguments;
use tempfile::TempDir;

/// What is typed, and how the message begins.
const REFUSED: &[(&str, &str)] = &[
    // The scene, wherever one is named.
    ("no-such-scene", "there is no built-in scene \"no-such-scene\"; the built-in scenes are"),
    (
        "lectuer",
        "there is no built-in scene \"lectuer\"; did you mean \"lecture\"? the built-in scenes are",
    ),
    (
        "Canonical",
        "there is no built-in scene \"Canonical\"; did you mean \"canonical\"? the built-in \
         scenes are",
    ),
    ("no-such.toml", "no-such.toml: there is no such file"),
    ("no-such.obj", "no-such.obj: there is no such file"),
    ("no-such.ply", "no-such.ply: there is no such file"),
    (
        "no-such.stl",
        "no-such.stl is neither a scene file (.toml) nor a mesh file (.obj, .ply); no others are read",
    ),
    (
        "empty.obj",
        "empty.obj: no faces (`f` statements), so nothing to draw; export the mesh as polygons",
    ),
    (
        "render no-such-scene",
        "there is no built-in scene \"no-such-scene\"; the built-in scenes are",
    ),
    (
        "pixel no-such-scene 1 1",
        "there is no built-in scene \"no-such-scene\"; the built-in scenes are",
    ),
    (
        "camera no-such-scene",
        "there is no built-in scene \"no-such-scene\"; the built-in scenes are",
    ),
    (
        "scenes no-such-scene",
        "there is no built-in scene \"no-such-scene\"; the built-in scenes are",
    ),
    ("canonical ties", "'ties' is a word too many: one scene is rendered at a time"),
    (
        "canonical pixel",
        "'pixel' is a subcommand, so it comes first: bothways pixel, then all else",
    ),
    (
        "--size 8x8 pixel",
        "'pixel' is a subcommand, so it comes first: bothways pixel, then all else",
    ),
    ("help", "for help, write bothways --help"),
    ("scenes canonical ties", "unexpected argument 'ties' found"),
    ("camera canonical ties", "unexpected argument 'ties' found"),
    // The camera, as `render`, `pixel` and `camera` take it.
    (
        "canonical --size 8",
        "invalid value '8' for '--size <WxH>': write it as WIDTHxHEIGHT, such as 640x480",
    ),
    (
        "canonical --size 0x8",
        "invalid value '0x8' for '--size <WxH>': both sides need at least 1 pixel",
    ),
    (
        "canonical --size 8x65537",
        "invalid value '8x65537' for '--size <WxH>': a side may have at most 65536 pixels (2^16)",
    ),
    (
        "canonical --size 65536x65536",
        "invalid value '65536x65536' for '--size <WxH>': an image may have at most 1073741824 \
         samples (2^30)",
    ),
    (
        "canonical --size -8x8",
        "invalid value '-8x8' for '--size <WxH>': '-8' is not a number of pixels; write it like \
         640x480",
    ),
    (
        "canonical --size 8x8 --size 9x9",
        "the argument '--size <WxH>' cannot be used multiple times",
    ),
    (
        "canonical --projection orthographic",
        "invalid value 'orthographic' for '--projection <PROJECTION>' [possible values: \
         perspective, parallel]",
    ),
    (
        "canonical --eye 1,2",
        "invalid value '1,2' for '--eye <X,Y,Z>': it has 2 numbers, but needs three, such as \
         1,-2,0.5",
    ),
    ("canonical --eye 1,2,x", "invalid value '1,2,x' for '--eye <X,Y,Z>': 'x' is not a number"),
    (
        "canonical --eye NaN,0,0",
        "invalid value 'NaN,0,0' for '--eye <X,Y,Z>': NaN is not a finite number",
    ),
    (
        "canonical --look-at 0,inf,0",
        "invalid value '0,inf,0' for '--look-at <X,Y,Z>': inf is not a finite number",
    ),
    (
        "canonical --look-at 0,0,0",
        "the camera of 'canonical' with --look-at: the eye [0, 0, 0] is the point it looks at; \
         move one of them",
    ),
    (
        "canonical --eye 1e30,0,0 --look-at 1e30,0,0",
        "the camera of 'canonical' with --eye, --look-at: the eye [1e30, 0, 0] is the point it \
         looks at; move one of them",
    ),
    (
        "canonical --up 0,0,0",
        "the camera of 'canonical' with --up: up is zero and so has no direction; give a vector \
         with a length",
    ),
    (
        "canonical --up 0,0,2",
        "the camera of 'canonical' with --up: up [0, 0, 2] runs along the direction of view; \
         choose another up",
    ),
    (
        "canonical --eye 0,0,0 --look-at 0,0,-1 --up 0,0,2",
        "the camera of 'canonical' with --eye, --look-at, --up: up [0, 0, 2] runs along the \
         direction of view; choose another up",
    ),
    (
        "canonical --distance 0",
        "the camera of 'canonical' with --distance: the distance is 0; it must be between 2^-64 \
         and 2^64 (5.4e-20 to 1.8e19)",
    ),
    (
        "canonical --distance -1",
        "the camera of 'canonical' with --distance: the distance is -1; it must be between 2^-64 \
         and 2^64 (5.4e-20 to 1.8e19)",
    ),
    (
        "canonical --distance 1e-30",
        "the camera of 'canonical' with --distance: the distance is 1e-30; it must be between \
         2^-64 and 2^64 (5.4e-20 to 1.8e19)",
    ),
    (
        "canonical --distance 1e30",
        "the camera of 'canonical' with --distance: the distance is 1e30; it must be between \
         2^-64 and 2^64 (5.4e-20 to 1.8e19)",
    ),
    (
        "canonical --distance 1e39",
        "invalid value '1e39' for '--distance <D>': 1e39 is out of range; numbers go up to 3.4e38",
    ),
    (
        "canonical --distance near",
        "invalid value 'near' for '--distance <D>': 'near' is not a number",
    ),
    (
        "canonical --viewport 1",
        "invalid value '1' for '--viewport <VW,VH>': it has 1 number, but needs two, such as 1.6,1",
    ),
    (
        "canonical --viewport 1,0",
        "the camera of 'canonical' with --viewport: the viewport's height is 0; it must be \
         between 2^-64 and 2^64 (5.4e-20 to 1.8e19)",
    ),
    (
        "canonical --viewport -1,1",
        "the camera of 'canonical' with --viewport: the viewport's width is -1; it must be \
         between 2^-64 and 2^64 (5.4e-20 to 1.8e19)",
    ),
    (
        "canonical --viewport 3e6,1",
        "the camera of 'canonical' with --viewport: the viewport is 3e6 x 1 at distance 1; its \
         sides may be at most 2^20 (about 1e6) times the distance",
    ),
    (
        "camera canonical --size 8",
        "invalid value '8' for '--size <WxH>': write it as WIDTHxHEIGHT, such as 640x480",
    ),
    (
        "camera canonical --projection orthographic",
        "invalid value 'orthographic' for '--projection <PROJECTION>' [possible values: \
         perspective, parallel]",
    ),
    (
        "camera canonical --eye 1",
        "invalid value '1' for '--eye <X,Y,Z>': it has 1 number, but needs three, such as 1,-2,0.5",
    ),
    (
        "camera canonical --look-at 0,0,0",
        "the camera of 'canonical' with --look-at: the eye [0, 0, 0] is the point it looks at; \
         move one of them",
    ),
    (
        "camera canonical --up 0,0,0",
        "the camera of 'canonical' with --up: up is zero and so has no direction; give a vector \
         with a length",
    ),
    (
        "camera canonical --distance 0",
        "the camera of 'canonical' with --distance: the distance is 0; it must be between 2^-64 \
         and 2^64 (5.4e-20 to 1.8e19)",
    ),
    (
        "camera canonical --viewport 0,1",
        "the camera of 'canonical' with --viewport: the viewport's width is 0; it must be \
         between 2^-64 and 2^64 (5.4e-20 to 1.8e19)",
    ),
    (
        "camera canonical --json=yes",
        "unexpected value 'yes' for '--json' found; no more were expected",
    ),
    (
        "pixel canonical 1 1 --size 8",
        "invalid value '8' for '--size <WxH>': write it as WIDTHxHEIGHT, such as 640x480",
    ),
    (
        "pixel canonical 1 1 --projection flat",
        "invalid value 'flat' for '--projection <PROJECTION>' [possible values: perspective, \
         parallel]",
    ),
    (
        "pixel canonical 1 1 --eye 1",
        "invalid value '1' for '--eye <X,Y,Z>': it has 1 number, but needs three, such as 1,-2,0.5",
    ),
    (
        "pixel canonical 1 1 --look-at 0,0,0",
        "the camera of 'canonical' with --look-at: the eye [0, 0, 0] is the point it looks at; \
         move one of them",
    ),
    (
        "pixel canonical 1 1 --up 0,0,0",
        "the camera of 'canonical' with --up: up is zero and so has no direction; give a vector \
         with a length",
    ),
    (
        "pixel canonical 1 1 --distance 0",
        "the camera of 'canonical' with --distance: the distance is 0; it must be between 2^-64 \
         and 2^64 (5.4e-20 to 1.8e19)",
    ),
    (
        "pixel canonical 1 1 --viewport 0,1",
        "the camera of 'canonical' with --viewport: the viewport's width is 0; it must be \
         between 2^-64 and 2^64 (5.4e-20 to 1.8e19)",
    ),
    // How to render, and where to.
    (
        "canonical --order both,object",
        "invalid value 'both,object' for '--order <ORDER>' [possible values: both, object, image]",
    ),
    (
        "canonical --method slow",
        "invalid value 'slow' for '--method <METHOD>' [possible values: fast, textbook]",
    ),
    (
        "canonical --samples 0",
        "invalid value '0' for '--samples <N>': give a whole number from 1 to 4294967295",
    ),
    (
        "canonical --samples -1",
        "invalid value '-1' for '--samples <N>': give a whole number from 1 to 4294967295",
    ),
    (
        "canonical --samples 1.5",
        "invalid value '1.5' for '--samples <N>': give a whole number from 1 to 4294967295",
    ),
    (
        "canonical --samples 4000000000",
        "--samples 4000000000: the image is 480x480 with 4000000000x4000000000 samples a pixel; \
         a side may have at most 65536 samples and the image at most 1073741824",
    ),
    (
        "canonical --size 8192x8 --samples 9",
        "--samples 9: the image is 8192x8 with 9x9 samples a pixel; a side may have at most \
         65536 samples and the image at most 1073741824",
    ),
    (
        "canonical --crop 10,20,30",
        "invalid value '10,20,30' for '--crop <ROW,COLUMN,HEIGHT,WIDTH>': it has 3 numbers, but \
         needs four; give ROW,COLUMN,HEIGHT,WIDTH in pixels of the image, such as 100,200,48,64",
    ),
    (
        "canonical --crop 64x48",
        "invalid value '64x48' for '--crop <ROW,COLUMN,HEIGHT,WIDTH>': '64x48' is not a whole \
         number from 0; give ROW,COLUMN,HEIGHT,WIDTH in pixels of the image, such as 100,200,48,64",
    ),
    (
        "canonical --crop -1,0,8,8",
        "invalid value '-1,0,8,8' for '--crop <ROW,COLUMN,HEIGHT,WIDTH>': '-1' is not a whole \
         number from 0; give ROW,COLUMN,HEIGHT,WIDTH",
    ),
    (
        "canonical --crop 0,0,8,1.5",
        "invalid value '0,0,8,1.5' for '--crop <ROW,COLUMN,HEIGHT,WIDTH>': '1.5' is not a whole \
         number from 0",
    ),
    (
        "canonical --crop ,",
        "invalid value ',' for '--crop <ROW,COLUMN,HEIGHT,WIDTH>': '' is not a whole number from 0",
    ),
    (
        "canonical --crop 0,0,8,99999999999",
        "invalid value '0,0,8,99999999999' for '--crop <ROW,COLUMN,HEIGHT,WIDTH>': 99999999999 is \
         out of range; an image has at most 65536 rows and columns",
    ),
    (
        "canonical --size 64x48 --crop 10,20,0,8",
        "--crop: the crop 10,20,0,8 of an image of 64x48 holds no pixel; its height and width, the \
         last two numbers, must be at least 1",
    ),
    (
        "canonical --size 64x48 --crop 40,0,9,64",
        "--crop: the crop 40,0,9,64 ends at pixel (48, 63), outside of an image of 64x48, whose \
         last pixel is (47, 63); give ROW,COLUMN,HEIGHT,WIDTH with ROW + HEIGHT up to 48 and COLUMN \
         + WIDTH up to 64",
    ),
    (
        "canonical --crop 0,4294967295,1,4294967295",
        "--crop: the crop 0,4294967295,1,4294967295 ends at pixel (0, 8589934589), outside of an \
         image of 480x480",
    ),
    (
        "render canonical --crop 480,0,1,1",
        "--crop: the crop 480,0,1,1 ends at pixel (480, 0), outside of an image of 480x480",
    ),
    (
        "canonical --threads 0",
        "invalid value '0' for '--threads <N>': give a whole number from 1 to 1024",
    ),
    (
        "canonical --threads 1025",
        "invalid value '1025' for '--threads <N>': give a whole number from 1 to 1024",
    ),
    (
        "canonical --threads all",
        "invalid value 'all' for '--threads <N>': give a whole number from 1 to 1024",
    ),
    (
        "canonical --stream",
        "--stream cannot be used with --order both: in image order every ray may need every \
         triangle",
    ),
    (
        "canonical --order object --stream",
        "only a mesh file (.obj, .ply) can be streamed, and \"canonical\" is none",
    ),
    (
        "canonical --repeat 0",
        "invalid value '0' for '--repeat <N>': give a whole number from 1 to 4294967295",
    ),
    (
        "canonical --repeat -3",
        "invalid value '-3' for '--repeat <N>': give a whole number from 1 to 4294967295",
    ),
    (
        "canonical --buffers exr",
        "invalid value 'exr' for '--buffers <BUFFERS>' [possible values: none, npy]",
    ),
    ("canonical --quiet --json", "the argument '--quiet' cannot be used with '--json'"),
    ("canonical --quiet=yes", "unexpected value 'yes' for '--quiet' found; no more were expected"),
    ("canonical --json=yes", "unexpected value 'yes' for '--json' found; no more were expected"),
    (
        "canonical --no-times=yes",
        "unexpected value 'yes' for '--no-times' found; no more were expected",
    ),
    ("canonical --no-such-option", "unexpected argument '--no-such-option' found"),
    ("canonical -o", "a value is required for '--output <DIR>' but none was supplied"),
    (
        "canonical -o file",
        "cannot write into the folder file: a file is where a folder would be; choose another \
         one with -o",
    ),
    (
        "canonical -o file/below/it",
        "cannot write into the folder file/below/it: a file is where a folder would be; choose \
         another one with -o",
    ),
    (
        "canonical --output file",
        "cannot write into the folder file: a file is where a folder would be; choose another \
         one with -o",
    ),
    // One pixel.
    ("pixel", "the following required arguments were not provided: <SCENE> <ROW> <COLUMN>"),
    ("pixel canonical 1", "the following required arguments were not provided: <COLUMN>"),
    (
        "pixel canonical 480 0",
        "there is no pixel (480, 0) in an image of 480x480: ROW goes from 0 to 479, COLUMN from \
         0 to 479",
    ),
    (
        "pixel canonical 0 64 --size 64x9",
        "there is no pixel (0, 64) in an image of 64x9: ROW goes from 0 to 8, COLUMN from 0 to 63",
    ),
    (
        "pixel canonical -1 0",
        "invalid value '-1' for '<ROW>': give a whole number; pixels are counted from 0",
    ),
    (
        "pixel canonical 0 1.5",
        "invalid value '1.5' for '<COLUMN>': give a whole number; pixels are counted from 0",
    ),
    (
        "pixel canonical 1 1 --samples 0",
        "invalid value '0' for '--samples <N>': give a whole number from 1 to 4294967295",
    ),
    (
        "pixel canonical 1 1 --samples 1000",
        "--samples 1000: the image is 480x480 with 1000x1000 samples a pixel; a side may have at \
         most 65536 samples and the image at most 1073741824",
    ),
    (
        "pixel canonical 1 1 --json=yes",
        "unexpected value 'yes' for '--json' found; no more were expected",
    ),
    // One triangle.
    ("cover", "the following required arguments were not provided: --size <WxH> <x,y x,y x,y>"),
    ("cover '1,1 9,2 3,7'", "the following required arguments were not provided: --size <WxH>"),
    ("cover '1,1 9,2' --size 10x8", "'1,1 9,2' has 2 corners; a triangle has three: 'x,y x,y x,y'"),
    (
        "cover '1,1 9,2 3,7 4,4' --size 10x8",
        "'1,1 9,2 3,7 4,4' has 4 corners; a triangle has three: 'x,y x,y x,y'",
    ),
    (
        "cover '1,1 9,2 3,x' --size 10x8",
        "corner 3 is '3,x': 'x' is not a number; write 'x,y x,y x,y'",
    ),
    (
        "cover '1,1 9,2 3' --size 10x8",
        "corner 3 is '3': it has 1 number, but needs two, such as 1.6,1; write 'x,y x,y x,y'",
    ),
    (
        "cover '1,1 9,2 3,1e39' --size 10x8",
        "corner 3 is '3,1e39': 1e39 is out of range; numbers go up to 3.4e38; write 'x,y x,y x,y'",
    ),
    (
        "cover '1,1 9,2 3,7' --size 10",
        "invalid value '10' for '--size <WxH>': write it as WIDTHxHEIGHT, such as 640x480",
    ),
    (
        "cover '1,1 9,2 3,7' --size 10x8 --table --json",
        "the argument '--table' cannot be used with '--json'",
    ),
    (
        "cover '1,1 9,2 3,7' --size 10x8 --table=yes",
        "unexpected value 'yes' for '--table' found; no more were expected",
    ),
    (
        "cover '1,1 9,2 3,7' --size 10x8 --json=yes",
        "unexpected value 'yes' for '--json' found; no more were expected",
    ),
    (
        "cover '1,1 9,2 3,7' --size 10x8 -o nowhere/t.png",
        "cannot write nowhere/t.png: there is no such folder; choose another file with -o",
    ),
    (
        "cover '1,1 9,2 3,7' --size 10x8 --output nowhere/t.png",
        "cannot write nowhere/t.png: there is no such folder; choose another file with -o",
    ),
    // Two files.
    ("diff", "the following required arguments were not provided: <A> <B>"),
    ("diff a.pgm", "the following required arguments were not provided: <B>"),
    ("diff a.pgm no-such.png", "cannot read no-such.png: there is no such file"),
    ("diff a.pgm .", "cannot read .: it is a folder"),
    (
        "diff a.pgm file",
        "file is neither a picture (PNG, PNM, BMP) nor a NumPy array (.npy); save it as one of \
         these",
    ),
    ("diff a.pgm damaged.png", "damaged.png: unexpected end of file"),
    (
        "diff a.pgm b.pgm",
        "A = a.pgm, B = b.pgm: A is 2 x 1 pixels and B is 1 x 2; compare files of one size (are \
         rows and columns swapped?)",
    ),
    ("diff a.pgm a.pgm a.pgm", "unexpected argument 'a.pgm' found"),
    (
        "diff a.pgm a.pgm --background black",
        "invalid value 'black' for '--background <COLOR>': write a # and six hexadecimal digits, \
         such as '#101418'",
    ),
    (
        "diff a.pgm a.pgm --background '#12345'",
        "invalid value '#12345' for '--background <COLOR>': write a # and six hexadecimal \
         digits, such as '#101418'",
    ),
    (
        "diff a.pgm a.pgm --json=yes",
        "unexpected value 'yes' for '--json' found; no more were expected",
    ),
    (
        "diff a.pgm a.pgm -o file",
        "cannot write into the folder file: a file is where a folder would be; choose another \
         one with -o",
    ),
    (
        "diff a.pgm a.pgm --output file",
        "cannot write into the folder file: a file is where a folder would be; choose another \
         one with -o",
    ),
    // Everything else.
    ("mesh", "the following required arguments were not provided: --output <FILE.obj> <KIND>"),
    ("mesh teapot", "the following required arguments were not provided: --output <FILE.obj>"),
    (
        "mesh teapott -o m.obj",
        "invalid value 'teapott' for '<KIND>': did you mean teapot? the kinds are",
    ),
    ("mesh ball -o m.obj", "invalid value 'ball' for '<KIND>': the kinds are"),
    (
        "mesh torus --divisions 2 -o m.obj",
        "a torus needs divisions of at least 3, 3; these are 2, 2",
    ),
    (
        "mesh torus --divisions x -o m.obj",
        "invalid value 'x' for '--divisions <N[,M]>': 'x' is not a number of divisions; give N \
         or N,M",
    ),
    (
        "mesh torus --divisions 3,3,3 -o m.obj",
        "invalid value '3,3,3' for '--divisions <N[,M]>': it has 3 numbers; give N or N,M",
    ),
    (
        "mesh torus --divisions -3 -o m.obj",
        "invalid value '-3' for '--divisions <N[,M]>': '-3' is not a number of divisions; give N \
         or N,M",
    ),
    (
        "mesh grid --divisions 4000000000 -o m.obj",
        "a grid with divisions 4000000000, 4000000000 would have more than 100000000 triangles; \
         take fewer",
    ),
    (
        "mesh grid -o nowhere/m.obj",
        "cannot write nowhere/m.obj: there is no such folder; choose another file with -o",
    ),
    (
        "mesh grid --output nowhere/m.obj",
        "cannot write nowhere/m.obj: there is no such folder; choose another file with -o",
    ),
    ("vectors all", "unexpected argument 'all' found"),
    (
        "vectors -o file",
        "cannot write into the folder file: a file is where a folder would be; choose another \
         one with -o",
    ),
    (
        "vectors --output file",
        "cannot write into the folder file: a file is where a folder would be; choose another \
         one with -o",
    ),
    ("vectors --json=yes", "unexpected value 'yes' for '--json' found; no more were expected"),
    ("completions", "the following required arguments were not provided: <SHELL>"),
    (
        "completions tcsh",
        "invalid value 'tcsh' for '<SHELL>' [possible values: bash, elvish, fish, powershell, zsh]",
    ),
];

fn bothways(home: &TempDir, args: &[String]) -> Command {
    let mut command = Command::cargo_bin("bothways").unwrap();
    command.current_dir(home).env_remove("RAYON_NUM_THREADS").args(args);
    command
}

/// Files that the lines above name.
fn home() -> TempDir {
    let home = tempfile::tempdir().unwrap();
    let write = |name: &str, content: &[u8]| fs::write(home.path().join(name), content).unwrap();
    write("file", b"no folder");
    write("empty.obj", b"v 0 0 0\n");
    write("damaged.png", b"\x89PNG\r\n\x1a\n");
    write("a.pgm", b"P2 2 1 1\n0 1\n");
    write("b.pgm", b"P2 1 2 1\n0 1\n");
    home
}

fn names(folder: &Path) -> BTreeSet<String> {
    let entries = fs::read_dir(folder).unwrap();
    entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

/// The message without its label, its lines joined, and without the usage that may follow.
fn message(stderr: &str) -> String {
    let first = stderr.split("\n\n").next().unwrap();
    let words: Vec<&str> = first.split_whitespace().collect();
    words.join(" ").strip_prefix("error: ").unwrap_or_else(|| panic!("{stderr}")).to_owned()
}

#[test]
fn bad_input_is_named_and_nothing_is_written() {
    let home = home();
    let before = names(home.path());
    for (line, expected) in REFUSED {
        let assert = bothways(&home, &arguments(line)).assert().code(2).stdout("");
        let stderr = String::from_utf8(assert.get_output().stderr.clone()).unwrap();
        let message = message(&stderr);
        assert!(message.starts_with(expected), "{line}\n  {message}\n  {expected}");
        assert!(!stderr.contains("panicked") && !stderr.contains("os error"), "{line}: {stderr}");
        assert_eq!(names(home.path()), before, "{line} wrote something");
    }
}

/// The long options that a help text lists.
fn options(help: &str) -> BTreeSet<&str> {
    let lines = help.lines().map(str::trim_start).filter(|line| line.starts_with('-'));
    let long = |line: &str| line.find("--").map(|at| at + 2);
    let names = lines.filter_map(|line| {
        let rest = &line[long(line)?..];
        rest.split(|c: char| !c.is_ascii_lowercase() && c != '-').next()
    });
    names.filter(|name| !["help", "version"].contains(name)).collect()
}

#[test]
fn no_option_is_left_out_above() {
    let home = home();
    let said = |args: &[&str]| {
        let args: Vec<String> = args.iter().map(|&word| word.to_owned()).collect();
        let assert = bothways(&home, &args).assert().code(0);
        String::from_utf8(assert.get_output().stdout.clone()).unwrap()
    };
    let help = said(&["-h"]);
    let commands = help.split("Commands:").nth(1).unwrap().split("\n\n").next().unwrap();
    // Lines that go on are indented more.
    let names = commands.lines().filter_map(|line| line.strip_prefix("  ")?.split(' ').next());
    let commands: Vec<&str> = names.filter(|name| !name.is_empty()).collect();
    assert!(commands.len() >= 9, "{commands:?}");
    for command in &commands {
        let help = said(&[command, "-h"]);
        let lines: Vec<Vec<String>> = REFUSED.iter().map(|(line, _)| arguments(line)).collect();
        // What begins with no subcommand is rendered.
        let of_command = lines.iter().filter(|words| match words[0].as_str() {
            word if commands.contains(&word) => word == *command,
            _ => *command == "render",
        });
        let tried: Vec<&String> = of_command.flatten().collect();
        assert!(!tried.is_empty(), "{command}");
        for option in options(&help) {
            let name = format!("--{option}");
            let is_tried = tried.iter().any(|word| word.split('=').next() == Some(&name));
            assert!(is_tried, "{command} {name}: no bad value is tried");
        }
    }
}
