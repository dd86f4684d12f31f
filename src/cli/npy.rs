//! Buffers as NumPy arrays: H×W, or H×W×N×N with several samples.

use bothways::common::Frame;
use bothways::common::frame::Ids;
use npyz::{AutoSerialize, NpyWriter, WriteOptions, WriterBuilder};
use std::io::{self, Write};

/// Writes the id of the visible primitive at each sample, all ones for nothing: as `u32`, or as `u64` in a scene of so many
/// primitives.
pub(super) fn write_ids(frame: &Frame, out: impl Write) -> io::Result<()> {
    match frame.ids() {
        Ids::Narrow(ids) => write(frame, ids, out),
        Ids::Wide(ids) => write(frame, ids, out),
    }
}

/// Writes the distance of the visible primitive at each sample, +∞ for nothing.
pub(super) fn write_distances(frame: &Frame, out: impl Write) -> io::Result<()> {
    write(frame, frame.distances(), out)
}

/// Writes a number for each pixel, row by row, in so many rows and columns.
pub(super) fn write_counts(
    [height, width]: [usize; 2],
    counts: &[u64],
    mut out: impl Write,
) -> io::Result<()> {
    let shape = [height as u64, width as u64];
    let mut writer: NpyWriter<u64, _> =
        WriteOptions::new().default_dtype().shape(&shape).writer(&mut out).begin_nd()?;
    writer.extend(counts.iter().copied())?;
    writer.finish()?;
    out.flush()
}

fn write<T: AutoSerialize + Copy>(
    frame: &Frame,
    buffer: &[T],
    mut out: impl Write,
) -> io::Result<()> {
    let [width, height] = frame.image().map(u64::from);
    let n = u64::from(frame.samples());
    let shape = if n == 1 { vec![height, width] } else { vec![height, width, n, n] };
    let mut writer: NpyWriter<T, _> =
        WriteOptions::new().default_dtype().shape(&shape).writer(&mut out).begin_nd()?;
    // A frame stores rows of samples; the array stores the samples of one pixel after another.
    for [i, j] in frame.pixels() {
        for sample in frame.samples_of(i as usize, j as usize) {
            writer.push(&buffer[sample])?;
        }
    }
    writer.finish()?;
    out.flush()
}
