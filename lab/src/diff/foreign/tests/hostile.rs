//! Files of few bytes that claim many pixels.

use super::*;

/// Small files of every format that claim this size.
fn claiming([width, height]: [u32; 2]) -> Vec<Vec<u8>> {
    let mut files = Vec::new();
    for [depth, color] in [[1, 0], [8, 0], [8, 2], [16, 6]] {
        let size = [width.to_be_bytes(), height.to_be_bytes()].concat();
        let header = [&size[..], &[depth, color, 0, 0, 0]].concat();
        // Two bytes of pixels: a zlib stream of one stored block.
        let pixels = [0x78, 0x01, 0x01, 2, 0, 0xfd, 0xff, 0, 1, 0, 3, 0, 2];
        files.push(png(&[(b"IHDR", &header), (b"IDAT", &pixels), (b"IEND", &[])]));
    }
    for kind in 1..7 {
        let most = if kind % 3 == 1 { "" } else { "255" };
        files.push(format!("P{kind} {width} {height} {most}\n1 0 1 0").into_bytes());
    }
    let pam = "DEPTH 3\nMAXVAL 255\nTUPLTYPE RGB\nENDHDR\nabcd";
    files.push(format!("P7\nWIDTH {width}\nHEIGHT {height}\n{pam}").into_bytes());
    for [bits, compression] in [[1, 0], [8, 0], [24, 0], [32, 0], [4, 2], [8, 1]] {
        let number = |number: u32| number.to_le_bytes();
        let header = [40, width, height, 1 | bits << 16, compression, 0, 0, 0, 0, 0].map(number);
        let start = [94, 0, 54].map(number).concat();
        files.push([b"BM", &start[..], &header.concat(), &[0; 40]].concat());
    }
    for descr in ["'|b1'", "'<u4'", "'<f8'"] {
        files.push(npy(descr, false, &format!("({height}, {width})"), &[0; 16]));
    }
    files
}

#[test]
fn sizes_that_a_file_cannot_fill_end_in_a_message() {
    // More than any image may have; as many as one may have; one in a row.
    for size in [[100_000, 100_000], [30_000, 30_000], [1, 65_536], [u32::MAX >> 1, 1]] {
        for file in claiming(size) {
            let problem = read_bytes(&file, None).unwrap_err();
            let start = String::from_utf8_lossy(&file[..8]).into_owned();
            assert!(problem.len() < 300, "{start:?}: {problem}");
            let reasons = [
                "ends early",
                "damaged",
                "a side may have at most",
                "cannot fill",
                "memory",
                "more than 1073741824 samples",
            ];
            assert!(reasons.iter().any(|said| problem.contains(said)), "{start:?}: {problem}");
        }
    }
}
