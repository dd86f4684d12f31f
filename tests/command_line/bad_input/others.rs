//! The bad values of all other commands.

/// The arguments, and the beginning of the message.
pub(super) const REFUSED: &[(&str, &str)] = &[
    // Of `rules`.
    ("rules ties", "unexpected argument 'ties' found"),
    ("fuzz --json=yes", "unexpected value 'yes' for '--json' found; no more were expected"),
    (
        "fuzz --seconds 0",
        "invalid value '0' for '--seconds <S>': give a number of seconds greater than 0, at most a year",
    ),
    ("fuzz --scenes 0", "invalid value '0' for '--scenes <N>': give a whole number from 1 to"),
    ("fuzz --seed -1", "invalid value '-1' for '--seed <K>': give a whole number from 0 to"),
    ("fuzz --first x", "invalid value 'x' for '--first <N>': give a whole number from 0 to"),
    (
        "fuzz --threads 0",
        "invalid value '0' for '--threads <N>': give a whole number from 1 to 1024",
    ),
    (
        "fuzz --scenes 1 --output file",
        "cannot write into the folder file: a file is where a folder would be; choose another one with -o",
    ),
    ("rules --json=yes", "unexpected value 'yes' for '--json' found; no more were expected"),
    (
        "camera canonical --json=yes",
        "unexpected value 'yes' for '--json' found; no more were expected",
    ),
    // Another system's scene.
    (
        "export canonical --as maya",
        "invalid value 'maya' for '--as <SYSTEM>' [possible values: pbrt, mitsuba, gltf, obj, ply]",
    ),
    ("export canonical", "the following required arguments were not provided: --as <SYSTEM>"),
    (
        "export canonical --as mitsuba --viewport 2,1",
        "cannot export 'canonical': Mitsuba's perspective camera has square pixels, but a viewport of 2 x 1",
    ),
    (
        "export canonical --as ply --output file",
        "cannot write into the folder file: a file is where a folder would be; choose another one with -o",
    ),
    // Another system's camera.
    (
        "camera canonical --as maya",
        "invalid value 'maya' for '--as <SYSTEM>' [possible values: opengl, vulkan, directx, pbrt,",
    ),
    (
        "camera canonical --near 1",
        "the following required arguments were not provided: --as <SYSTEM>",
    ),
    (
        "camera canonical --as opengl --near x",
        "invalid value 'x' for '--near <DEPTH>': 'x' is not a number",
    ),
    (
        "camera canonical --as opengl --far inf",
        "invalid value 'inf' for '--far <DEPTH>': inf is not a finite number",
    ),
    (
        "camera canonical --as vulkan --near 0",
        "the camera of 'canonical': the near plane is at 0, but a perspective camera needs one before the eye;",
    ),
    (
        "camera canonical --as directx --near 3 --far 2",
        "the camera of 'canonical': the far plane at 2 does not lie behind the near plane at 3;",
    ),
    (
        "camera canonical --as pbrt --near 1",
        "the camera of 'canonical': pbrt has no near and no far plane; leave --near and --far out",
    ),
    (
        "camera canonical --as mitsuba --viewport 2,1",
        "the camera of 'canonical': Mitsuba's perspective camera has square pixels, but a viewport of 2 x 1",
    ),
    (
        "camera canonical --as blender --size 2x2",
        "the camera of 'canonical': Blender's images have at least 4x4 pixels, and this one has 2x2;",
    ),
    ("camera parallel --as opencv", "the camera of 'parallel': OpenCV has no parallel camera:"),
    ("camera parallel --as colmap", "the camera of 'parallel': COLMAP has no parallel camera:"),
    // A folder is no file.
    (
        "export canonical --as gltf -o new/l.glb",
        "cannot write into the folder new/l.glb: -o names a folder, and this is the name of a file, which is called \
         after the scene; choose another one with -o (one that is called so as new/l.glb/)",
    ),
    (
        "export canonical --as obj -o zz.OBJ",
        "cannot write into the folder zz.OBJ: -o names a folder,",
    ),
    // A whole renderer.
    ("check", "the following required arguments were not provided: <THEIRS>"),
    ("check no-such", "cannot list the folder no-such: there is no such folder"),
    ("check a.pgm", "cannot list the folder a.pgm: it is a file, not a folder"),
    (
        "check .",
        "no file of . (PNG, PNM, BMP, JPEG, EXR or NPY) has the name of a scene of the set",
    ),
    ("check . .", ". is no conformance set: it has no index.json of one"),
    (
        "check . cut",
        "cut/index.json is not the index of a conformance set, or it is damaged: EOF while parsing a value at line 2 \
         column 8; write the set again with bothways vectors",
    ),
    (
        "check . --background red",
        "invalid value 'red' for '--background <COLOR>': write a # and six hexadecimal digits",
    ),
    (
        "check . --html file/check.html",
        "cannot write file/check.html: a file is where a folder would be; choose another file with --html",
    ),
    (
        "check . --html check.png",
        "cannot write check.png: a page is an .html file, and .png is none; end the name in .html",
    ),
    ("check . --json=yes", "unexpected value 'yes' for '--json' found; no more were expected"),
    // A course.
    ("grade", "the following required arguments were not provided: <SCENE> <FILE>..."),
    ("grade canonical", "the following required arguments were not provided: <FILE>..."),
    ("grade no-such a.pgm", "there is no built-in scene \"no-such\""),
    (
        "grade canonical a.pgm --csv file/marks.csv",
        "cannot write file/marks.csv: a file is where a folder would be; choose another file with --csv",
    ),
    (
        "grade canonical a.pgm --csv marks.xlsx",
        "cannot write marks.xlsx: a table is a .csv file, and .xlsx is none; end the name in .csv",
    ),
    (
        "grade canonical a.pgm --background red",
        "invalid value 'red' for '--background <COLOR>': write a # and six hexadecimal digits",
    ),
    (
        "grade canonical a.pgm --json=yes",
        "unexpected value 'yes' for '--json' found; no more were expected",
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
    // A folder in the place of a scene.
    ("render .", ". is a folder; name a scene file (.toml) or a mesh file"),
    // Figures.
    ("figure", "the following required arguments were not provided: <KIND>"),
    (
        "figure edge-function",
        "invalid value 'edge-function' for '<KIND>': did you mean edge-functions? the kinds are image, camera",
    ),
    ("figure camera no-such", "there is no built-in scene \"no-such\""),
    (
        "figure grid ties --pixel 64,0",
        "cannot draw grid of 'ties': there is no pixel (64, 0) in an image of 64x64: rows go from 0 to 63, columns \
         from 0 to 63",
    ),
    (
        "figure grid ties --pixel 1",
        "invalid value '1' for '--pixel <ROW,COLUMN>': give ROW,COLUMN in whole numbers counted from 0",
    ),
    (
        "figure grid ties --pixel 1,1 --pixel 2,2",
        "grid looks at 1 pixel, but --pixel is given 2 times",
    ),
    (
        "figure work ties --pixel 1,1",
        "--pixel chooses what a figure looks at, and work does not; it is for image, camera, grid",
    ),
    (
        "figure grid ties --samples 0",
        "invalid value '0' for '--samples <N>': give a whole number from 1",
    ),
    (
        "figure grid ties --samples 2",
        "--samples changes figures that show pictures by sample, and grid does not; it is for side-by-side",
    ),
    (
        "figure grid ties --object-rules corner",
        "--object-rules and --image-rules change figures that compare the orders, and grid does not; it is for \
         side-by-side, zoom, reasons",
    ),
    (
        "figure zoom ties --object-rules no-such",
        "invalid value 'no-such' for '--object-rules <RULE>'",
    ),
    (
        "figure zoom ties --image-rules no-such",
        "invalid value 'no-such' for '--image-rules <RULE>'",
    ),
    (
        "figure grid ties --theme blue",
        "invalid value 'blue' for '--theme <THEME>': 'blue' is no theme; there are dark and light",
    ),
    (
        "figure grid ties --width 10",
        "invalid value '10' for '--width <PIXELS>': give a whole number of pixels from 160 to 7680",
    ),
    (
        "figure grid ties --counts there",
        "--counts writes what the kind work shows, and grid shows no work; draw work",
    ),
    (
        "figure work ties --size 8x8 -o w.svg --counts file",
        "cannot write into the folder file: a file is where a folder would be; choose another one with --counts",
    ),
    (
        "figure grid ties -o figure.jpg",
        "cannot write figure.jpg: a figure is written as SVG or PNG, and .jpg is neither; end the name in .svg or .png",
    ),
    (
        "figure grid ties --output file/figure.svg",
        "cannot write file/figure.svg: a file is where a folder would be; choose another file with -o",
    ),
    // A film.
    ("film", "the following required arguments were not provided: <SCENE>"),
    ("film no-such", "there is no built-in scene \"no-such\""),
    (
        "film canonical --method slow",
        "invalid value 'slow' for '--method <METHOD>' [possible values: fast, textbook]",
    ),
    (
        "film canonical --seconds 0",
        "invalid value '0' for '--seconds <S>': give a number of seconds greater than 0, at most 600",
    ),
    (
        "film canonical --seconds nan",
        "invalid value 'nan' for '--seconds <S>': give a number of seconds greater than 0, at most 600",
    ),
    (
        "film canonical --pause -1",
        "invalid value '-1' for '--pause <S>': give a number of seconds from 0 to 600",
    ),
    (
        "film canonical --fps 30",
        "invalid value '30' for '--fps <N>': choose 1, 2, 4, 5, 10, 20, 25, 50 or 100: a GIF counts \
         hundredths of a second",
    ),
    (
        "film canonical --fps 100 --output fast.gif",
        "--fps 100: browsers show such short frames of a GIF ten times as long; choose 50, or write an .mp4 or \
         a folder of frames",
    ),
    (
        "film canonical --seconds 600 --fps 50",
        "--seconds, --fps and --pause: the film would have 30100 frames, and 10000 are the most; choose \
         fewer seconds, or fewer frames a second",
    ),
    (
        "film canonical --width 1000",
        "invalid value '1000' for '--width <N>': give a multiple of 32 from 480 to 3840, such as 960 or 1920",
    ),
    (
        "film canonical --theme red",
        "invalid value 'red' for '--theme <THEME>': 'red' is no theme; there are dark and light",
    ),
    (
        "film canonical -o film.webp",
        "cannot write film.webp: a film is a .gif, an animated .png, an .mp4, or a folder of frames, and \
         .webp is none; end the name in one of them, or in / for a folder",
    ),
    (
        "film canonical --output file/film.gif",
        "cannot write file/film.gif: a file is where a folder would be; choose another file with -o",
    ),
    (
        "film canonical -o file/",
        "cannot write into the folder file/: a file is where a folder would be; choose another one with -o",
    ),
    (
        "film canonical -o - --json",
        "--json and the film would both go to standard output; name a file with -o",
    ),
    (
        "film canonical --json=yes",
        "unexpected value 'yes' for '--json' found; no more were expected",
    ),
    (
        "film canonical --size 4000x4000",
        "a film of canonical: a film shows pictures of at most 2,097,152 pixels, and 4000x4000 has \
         16,000,000; take a smaller --size",
    ),
    ("film many --size 640x480", "a film of many: the textbook would take 3"),
    // Slides.
    ("slides no-such", "there is no built-in scene \"no-such\""),
    ("slides canonical --theme blue", "invalid value 'blue' for '--theme <THEME>'"),
    (
        "slides canonical --allow-outside=yes",
        "unexpected value 'yes' for '--allow-outside' found; no more were expected",
    ),
    (
        "scenes canonical --allow-outside=yes",
        "unexpected value 'yes' for '--allow-outside' found; no more were expected",
    ),
    (
        "slides canonical --no-films=yes",
        "unexpected value 'yes' for '--no-films' found; no more were expected",
    ),
    (
        "slides canonical --output file",
        "cannot write into the folder file: a file is where a folder would be; choose another one with -o",
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
        "cover '1,1 9,2 3,7' --size 10x8 -o file/t.png",
        "cannot write file/t.png: a file is where a folder would be; choose another file with -o",
    ),
    (
        "cover '1,1 9,2 3,7' --size 10x8 --output file/t.png",
        "cannot write file/t.png: a file is where a folder would be; choose another file with -o",
    ),
    (
        "cover '1,1 9,2 3,7' --size 10x8 -o .",
        "cannot write .: a folder of this name is there; choose another file with -o",
    ),
    (
        "cover '1,1 9,2 3,7' --size 10x8 -o t.pgm",
        "cannot write t.pgm: a mask is a .png file, and .pgm is none; end the name in .png",
    ),
    (
        "cover '1,1 9,2 3,7' --size 10x8 --json -o -",
        "--json and the mask would both go to standard output; name a file with -o",
    ),
    // All other commands.
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
        "mesh grid -o file/m.obj",
        "cannot write file/m.obj: a file is where a folder would be; choose another file with -o",
    ),
    (
        "mesh grid --output file/m.obj",
        "cannot write file/m.obj: a file is where a folder would be; choose another file with -o",
    ),
    (
        "mesh grid -o new/m.glb",
        "cannot write new/m.glb: a mesh is written as OBJ, PLY or STL, and .glb is none of them; end \
         the name in .obj, .ply or .stl",
    ),
    (
        "mesh grid -o new/m.",
        "cannot write new/m.: a mesh is written as OBJ, PLY or STL, and . is none of them; end the name in",
    ),
    ("mesh grid -o new/", "cannot write new/: it names a folder; choose another file with -o"),
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
    (
        "sweep triangels",
        "invalid value 'triangels' for '[AXIS]...': there is no axis 'triangels'; the axes are",
    ),
    (
        "sweep --size 9000x9000",
        "invalid value '9000x9000' for '--size <WxH>': the image of a sweep may have at most",
    ),
    (
        "sweep --size 640",
        "invalid value '640' for '--size <WxH>': write it as WIDTHxHEIGHT, such as 640x480",
    ),
    (
        "sweep --most 11M",
        "invalid value '11M' for '--most <N>': give a number of triangles from 100 to 10M",
    ),
    (
        "sweep --most -5",
        "invalid value '-5' for '--most <N>': give a number of triangles from 100 to 10M",
    ),
    ("sweep --rounds 0", "invalid value '0' for '--rounds <N>': give a whole number from 1 to 100"),
    (
        "sweep --threads 0",
        "invalid value '0' for '--threads <N>': give a whole number from 1 to 1024",
    ),
    (
        "sweep --no-times=yes",
        "unexpected value 'yes' for '--no-times' found; no more were expected",
    ),
    ("sweep --fresh=yes", "unexpected value 'yes' for '--fresh' found; no more were expected"),
    (
        "sweep --theme blue",
        "invalid value 'blue' for '--theme <THEME>': 'blue' is no theme; there are dark and light",
    ),
    ("sweep --png=yes", "unexpected value 'yes' for '--png' found; no more were expected"),
    ("sweep --json=yes", "unexpected value 'yes' for '--json' found; no more were expected"),
    (
        "sweep --output file",
        "cannot write into the folder file: a file is where a folder would be; choose another one with -o",
    ),
    (
        "sweep -o -",
        "-o - is standard output, which takes one file, and here a folder of files is written",
    ),
    ("completions", "the following required arguments were not provided: <SHELL>"),
    (
        "completions tcsh",
        "invalid value 'tcsh' for '<SHELL>' [possible values: bash, elvish, fish, powershell, zsh]",
    ),
];
