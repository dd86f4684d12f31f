//! The bad values of `render`: its scene, its options and its output.

/// The arguments, and the beginning of the message.
pub(super) const REFUSED: &[(&str, &str)] = &[
    // The scene, in every command with a scene.
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
        "no-such.off",
        "no-such.off is neither a scene file (.toml) nor a mesh file (.obj, .ply, .stl, .gltf, .glb); no others are read",
    ),
    (
        "empty.obj",
        "empty.obj: no faces (`f` statements), so nothing to draw; export the mesh as polygons",
    ),
    // The rules of ordinary renderers.
    (
        "ties --object-rules exakt",
        "invalid value 'exakt' for '--object-rules <RULE>': there is no such rule of object order; choose exact or",
    ),
    (
        "ties --object-rules near-clip:nan",
        "invalid value 'near-clip:nan' for '--object-rules <RULE>': near-clip:Z takes a positive depth",
    ),
    (
        "ties --image-rules snapped:8",
        "invalid value 'snapped:8' for '--image-rules <RULE>': there is no such rule of image order; choose exact or",
    ),
    (
        "render ties --image-rules corner --order object",
        "--image-rules corner is for image order, which --order leaves out; drop one of them",
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
    ("help pixl", "unrecognized subcommand 'pixl'"),
    ("pixle ties 3 4", "there is no command 'pixle'; did you mean 'bothways pixel ties 3 4'?"),
    ("scenes canonical ties", "unexpected argument 'ties' found"),
    ("camera canonical ties", "unexpected argument 'ties' found"),
    // The options for rendering and for output.
    (
        "canonical --order both,object",
        "invalid value 'both,object' for '--order <ORDER>' [possible values: both, object, image]",
    ),
    (
        "canonical --method slow",
        "invalid value 'slow' for '--method <METHOD>' [possible values: fast, textbook]",
    ),
    (
        "canonical --max-memory 0",
        "invalid value '0' for '--max-memory <SIZE>': the program by itself takes most of 64 MiB, the least that can be \
         given; write a whole number with K, M, G or T, such as 500M or 2G",
    ),
    (
        "canonical --max-memory -1G",
        "invalid value '-1G' for '--max-memory <SIZE>': write a whole number with K, M, G or T, such as 500M or 2G",
    ),
    (
        "canonical --size 30000x30000 --max-memory 1G",
        "900,000,000 samples need at least 28.5 GiB of memory, more than --max-memory leaves (",
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
        "only a mesh file (.obj, .ply, .stl) can be streamed, and \"canonical\" is none",
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
        "canonical --verify 0",
        "invalid value '0' for '--verify <N>': give a whole number from 1 to 4294967295",
    ),
    (
        "canonical --verify 9 --method textbook",
        "--verify holds the fast method against the textbook, which --method textbook is; leave one of them out",
    ),
    (
        "canonical --buffers tiff",
        "invalid value 'tiff' for '--buffers <BUFFERS>' [possible values: none, npy, exr]",
    ),
    (
        "canonical --only masks",
        "invalid value 'masks' for '--only <WHAT>' [possible values: picture, mask, difference, slide, report]",
    ),
    (
        "canonical --order image --only difference",
        "--only difference shows both orders, and --order draws image order alone; leave one of them out",
    ),
    (
        "canonical --order object --only picture,slide",
        "--only slide shows both orders, and --order draws object order alone; leave one of them out",
    ),
    ("canonical --quiet --json", "the argument '--quiet' cannot be used with '--json'"),
    ("canonical --quiet=yes", "unexpected value 'yes' for '--quiet' found; no more were expected"),
    ("canonical --json=yes", "unexpected value 'yes' for '--json' found; no more were expected"),
    (
        "canonical --no-times=yes",
        "unexpected value 'yes' for '--no-times' found; no more were expected",
    ),
    (
        "canonical --no-counts=yes",
        "unexpected value 'yes' for '--no-counts' found; no more were expected",
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
        "canonical -o -",
        "-o - is standard output, which takes one file, and here a folder of files is written; \
         name a folder (one that is called - as ./-)",
    ),
    (
        "canonical --output file",
        "cannot write into the folder file: a file is where a folder would be; choose another \
         one with -o",
    ),
];
