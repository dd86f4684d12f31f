//! The flags of a scene's camera and of its files, for `render`, `camera`, `pixel`, `film`, `grade` and `diff`.

/// The arguments after each of [`COMMANDS`], and the beginning of the message.
pub(super) const REFUSED: &[(&str, &str)] = &[
    (
        "--allow-outside=yes",
        "unexpected value 'yes' for '--allow-outside' found; no more were expected",
    ),
    ("--size 8", "invalid value '8' for '--size <WxH>': write it as WIDTHxHEIGHT, such as 640x480"),
    ("--size 0x8", "invalid value '0x8' for '--size <WxH>': both sides need at least 1 pixel"),
    (
        "--size 8x65537",
        "invalid value '8x65537' for '--size <WxH>': a side may have at most 65536 pixels (2^16)",
    ),
    (
        "--size 65536x65536",
        "invalid value '65536x65536' for '--size <WxH>': an image may have at most 1073741824 \
         samples (2^30)",
    ),
    (
        "--size -8x8",
        "invalid value '-8x8' for '--size <WxH>': '-8' is not a number of pixels; write it like \
         640x480",
    ),
    ("--size 8x8 --size 9x9", "the argument '--size <WxH>' cannot be used multiple times"),
    (
        "--projection orthographic",
        "invalid value 'orthographic' for '--projection <PROJECTION>' [possible values: \
         perspective, parallel]",
    ),
    (
        "--eye 1,2",
        "invalid value '1,2' for '--eye <X,Y,Z>': it has 2 numbers, but needs three, such as \
         1,-2,0.5",
    ),
    (
        "--eye 1",
        "invalid value '1' for '--eye <X,Y,Z>': it has 1 number, but needs three, such as 1,-2,0.5",
    ),
    ("--eye 1,2,x", "invalid value '1,2,x' for '--eye <X,Y,Z>': 'x' is not a number"),
    ("--eye NaN,0,0", "invalid value 'NaN,0,0' for '--eye <X,Y,Z>': NaN is not a finite number"),
    (
        "--look-at 0,inf,0",
        "invalid value '0,inf,0' for '--look-at <X,Y,Z>': inf is not a finite number",
    ),
    (
        "--look-at 0,0,0",
        "the camera of 'canonical' with --look-at: the eye [0, 0, 0] is the point it looks at; \
         move one of them",
    ),
    (
        "--eye 1e30,0,0 --look-at 1e30,0,0",
        "the camera of 'canonical' with --eye, --look-at: the eye [1e30, 0, 0] is the point it \
         looks at; move one of them",
    ),
    (
        "--up 0,0,0",
        "the camera of 'canonical' with --up: up is zero and so has no direction; give a vector \
         with a length",
    ),
    (
        "--up 0,0,2",
        "the camera of 'canonical' with --up: up [0, 0, 2] runs along the direction of view; \
         choose another up",
    ),
    (
        "--eye 0,0,0 --look-at 0,0,-1 --up 0,0,2",
        "the camera of 'canonical' with --eye, --look-at, --up: up [0, 0, 2] runs along the \
         direction of view; choose another up",
    ),
    (
        "--distance 0",
        "the camera of 'canonical' with --distance: the distance is 0; it must be between 2^-64 \
         and 2^64 (5.4e-20 to 1.8e19)",
    ),
    (
        "--distance -1",
        "the camera of 'canonical' with --distance: the distance is -1; it must be between 2^-64 \
         and 2^64 (5.4e-20 to 1.8e19)",
    ),
    (
        "--distance 1e-30",
        "the camera of 'canonical' with --distance: the distance is 1e-30; it must be between \
         2^-64 and 2^64 (5.4e-20 to 1.8e19)",
    ),
    (
        "--distance 1e30",
        "the camera of 'canonical' with --distance: the distance is 1e30; it must be between \
         2^-64 and 2^64 (5.4e-20 to 1.8e19)",
    ),
    (
        "--distance 1e39",
        "invalid value '1e39' for '--distance <D>': 1e39 is out of range; numbers go up to 3.4e38",
    ),
    ("--distance near", "invalid value 'near' for '--distance <D>': 'near' is not a number"),
    (
        "--viewport 1",
        "invalid value '1' for '--viewport <VW,VH>': it has 1 number, but needs two, such as 1.6,1",
    ),
    (
        "--viewport 0,1",
        "the camera of 'canonical' with --viewport: the viewport's width is 0; it must be between \
         2^-64 and 2^64 (5.4e-20 to 1.8e19)",
    ),
    (
        "--viewport 1,0",
        "the camera of 'canonical' with --viewport: the viewport's height is 0; it must be \
         between 2^-64 and 2^64 (5.4e-20 to 1.8e19)",
    ),
    (
        "--viewport -1,1",
        "the camera of 'canonical' with --viewport: the viewport's width is -1; it must be \
         between 2^-64 and 2^64 (5.4e-20 to 1.8e19)",
    ),
    (
        "--viewport 3e6,1",
        "the camera of 'canonical' with --viewport: the viewport is 3e6 x 1 at distance 1; its \
         sides may be at most 2^20 (about 1e6) times the distance",
    ),
    (
        "--fov 180",
        "the camera of 'canonical' with --fov: the field of view is 180 degrees; it must be greater \
         than 0 and less than 180",
    ),
    (
        "--fov -40",
        "the camera of 'canonical' with --fov: the field of view is -40 degrees; it must be greater \
         than 0 and less than 180",
    ),
    (
        "--fov 40 --projection parallel",
        "the camera of 'canonical' with --projection, --fov: a parallel camera has no field of view, \
         as its rays never part; give a viewport instead",
    ),
    ("--fov 179.99999", "the camera of 'canonical' with --fov: the viewport is"),
    (
        "--fov 40 --viewport 1,1",
        "the argument '--fov <DEGREES>' cannot be used with '--viewport <VW,VH>'",
    ),
];

/// The commands with camera flags, all for the scene with the camera that the messages name.
pub(super) const COMMANDS: &[&str] = &[
    "canonical",
    "camera canonical",
    "export canonical --as ply",
    "pixel canonical 1 1",
    "figure image canonical",
    "film canonical",
    "grade canonical a.pgm",
    "diff a.pgm a.pgm --scene canonical",
];
