//! The bad values of `diff`: two files, and what they are compared by.

/// The arguments, and the beginning of the message.
pub(super) const REFUSED: &[(&str, &str)] = &[
    ("diff", "the following required arguments were not provided: <A> <B>"),
    ("diff a.pgm", "the following required arguments were not provided: <B>"),
    ("diff a.pgm no-such.png", "cannot read no-such.png: there is no such file"),
    ("diff a.pgm .", ". is a folder and a.pgm is none; compare two files, or two folders"),
    (
        "diff a.pgm file",
        "file is neither a picture (PNG, PNM, BMP, JPEG, EXR) nor a NumPy array (.npy); save it as \
         one of these",
    ),
    ("diff a.pgm empty.png", "empty.png is empty; write it again"),
    (
        "diff a.pgm damaged.png",
        "damaged.png: the file ends early, after 8 bytes; copy it or write it again",
    ),
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
        "diff a.pgm a.pgm --tolerance -1",
        "invalid value '-1' for '--tolerance <X>': give a number from 0, such as 1e-4 for a \
         ten-thousandth of the distance",
    ),
    (
        "diff a.pgm a.pgm --scene canonical --pixel 12",
        "invalid value '12' for '--pixel <ROW,COLUMN>': write a row and a column, such as 12,40; both count \
         from 0",
    ),
    (
        "diff a.pgm a.pgm --html page.png",
        "cannot write page.png: a page is an .html file, and .png is none; end the name in .html",
    ),
    (
        "diff a.pgm a.pgm --color-tolerance nan",
        "invalid value 'nan' for '--color-tolerance <STEPS>': give a number from 0; 255 is the \
         difference of black and white",
    ),
    (
        "diff a.pgm a.pgm --normal-tolerance 181",
        "invalid value '181' for '--normal-tolerance <DEGREES>': give an angle from 0 to 180 degrees",
    ),
    (
        "diff a.pgm a.pgm --allow-pixels 1.5",
        "invalid value '1.5' for '--allow-pixels <N>': give a whole number of pixels, from 0",
    ),
    (
        "diff a.pgm a.pgm --ignore 0,0,1",
        "invalid value '0,0,1' for '--ignore <ROW,COLUMN,HEIGHT,WIDTH>': it has 3 numbers, but needs \
         four; give ROW,COLUMN,HEIGHT,WIDTH in pixels of the image, such as 100,200,48,64",
    ),
    (
        "diff a.pgm a.pgm --ignore 0,1,1,2",
        "A = a.pgm, B = a.pgm: --ignore: the rectangle 0,1,1,2 ends at pixel (0, 2), outside of an \
         image of 2x1, whose last pixel is (0, 1);",
    ),
    (
        "diff a.pgm a.pgm --ignore 0,0,1,2",
        "A = a.pgm, B = a.pgm: every pixel is ignored, so that nothing is left to compare; ignore less",
    ),
    (
        "diff a.pgm a.pgm --channels R,,B",
        "invalid value 'R,,B' for '--channels <NAME[,NAME...]>': give names with commas between them, \
         such as R,G,B",
    ),
    (
        "diff a.pgm a.pgm --channels Z",
        "--channels chooses channels of an EXR, and neither a.pgm nor a.pgm has any; leave it out",
    ),
    (
        "diff a.pgm a.pgm --channels Z --channels Z --channels Z",
        "--channels is given 3 times; give it once for both files, or twice, for A and for B",
    ),
    (
        "diff a.pgm a.pgm --normals",
        "a.pgm: normals are read from floats; save them as NPY (H x W x 3) or EXR, or leave --normals \
         out",
    ),
    (
        "diff a.pgm a.pgm --depth z",
        "invalid value 'z' for '--depth <MEANING>': give t, ray, axis or opengl:NEAR,FAR",
    ),
    (
        "diff a.pgm a.pgm --depth opengl:0,1",
        "invalid value 'opengl:0,1' for '--depth <MEANING>': the planes of OpenGL are two distances \
         above 0, such as opengl:0.1,100;",
    ),
    (
        "diff a.pgm a.pgm --depth axis",
        "--depth says what distances mean, and neither a.pgm nor a.pgm has any; leave it out, or choose \
         a channel of distances with --channels",
    ),
    (
        "diff a.pgm a.pgm --scene canonicle",
        "there is no built-in scene \"canonicle\"; did you mean \"canonical\"?",
    ),
    (
        "diff a.pgm a.pgm --eye 1,2,3 --fov 40",
        "--eye, --fov: the camera of which scene? Name it with --scene SCENE, or leave --eye, --fov out",
    ),
    (
        "diff a.pgm a.pgm --json=yes",
        "unexpected value 'yes' for '--json' found; no more were expected",
    ),
    (
        "diff a.pgm a.pgm --allow-outside",
        "--allow-outside: the files of which scene? Name it with --scene SCENE, or leave --allow-outside out",
    ),
    (
        "diff a.pgm a.pgm -o file",
        "cannot write into the folder file: a file is where a folder would be; choose another \
         one with -o",
    ),
    (
        "diff a.pgm a.pgm -o -",
        "-o - is standard output, which takes one file, and here a folder of files is written; \
         name a folder (one that is called - as ./-)",
    ),
    (
        "diff a.pgm a.pgm --output file",
        "cannot write into the folder file: a file is where a folder would be; choose another \
         one with -o",
    ),
];
