//! Buffers as one EXR file: what each order saw at every sample, in channels that are named after the order.
//!
//! All channels have one size, so that every viewer opens the file: several samples a pixel are several pixels here.
//! Ids are integers of 32 bits, all else is floats of 32 bits; zip loses no bit of either. The format has no integers of
//! 64 bits: in a scene of so many primitives, a second channel has the higher half.

use ::exr::block::chunk::Chunk;
use ::exr::block::lines::LineRefMut;
use ::exr::block::writer::{ChunkWriter, ChunksWriter};
use ::exr::block::{
    BlockIndex, UncompressedBlock, enumerate_ordered_header_block_indices, write as write_blocks,
};
use ::exr::compression::Compression;
use ::exr::error::{Error, UnitResult};
use ::exr::math::Vec2;
use ::exr::meta::attribute::{ChannelDescription, IntegerBounds, LineOrder, SampleType, Text};
use ::exr::meta::header::Header;
use ::exr::meta::{BlockDescription, MetaData};
use bothways::common::camera::Projection;
use bothways::common::frame::Ids;
use bothways::common::look::color::linear_from_srgb;
use bothways::common::raster::Region;
use bothways::common::{Camera, Frame, View};
use bothways::figure::work_at_samples;
use bothways::orders::{Method, Order, Rendered};
use bothways::picture::color_of_id;
use rayon::prelude::*;
use std::borrow::Cow;
use std::io::{self, Seek, Write};

/// The name of the file.
pub(super) const NAME: &str = "buffers.exr";

/// The blocks that are compressed at once, before they are written.
const AT_ONCE: usize = 32;

/// What each channel holds; the file's own comment.
const COMMENT: &str = "object.* is object order (rasterization), image.* is image order (ray tracing). R, G, B: linear \
light, the background where nothing is seen. normal.X, Y, Z: the unit normal in world space, towards the viewer; zero \
for nothing. depth.Z: the depth along the camera's axis; t: in lengths of the viewing ray's direction; both +infinity \
for nothing. id: the primitive's number from 0 in scene order, 4294967295 for nothing. id_color.R, G, B: ids as colors. \
coverage: 1 or 0. work: primitives and boxes tested there.";

/// What is added where ids have 64 bits.
const WIDE_IDS: &str = " The scene has ids of 64 bits: the id is id + 2^32 id_high, and both are 4294967295 for \
nothing.";

/// What one order saw.
#[derive(Debug)]
pub(super) struct Layer<'a> {
    pub(super) order: Order,
    /// With normals.
    pub(super) frame: &'a Frame,
    /// The work at each sample, where it is known.
    pub(super) work: Option<&'a [f32]>,
}

/// The work at each sample of a frame, if it was counted for the whole frame.
pub(super) fn work(view: &View, rendered: &Rendered) -> Option<Vec<f32>> {
    rendered.work()?;
    let Rendered { order, method, frame, .. } = rendered;
    #[expect(
        clippy::cast_precision_loss,
        reason = "counts below 2^24 are exact, greater ones are nearly so"
    )]
    let work = match method {
        // By the definition of the loop, every primitive is tested at every sample.
        Method::Textbook => vec![view.scene.primitive_count() as f32; frame.ids().len()],
        Method::Fast => {
            let counts = work_at_samples(view, *order, &frame.options());
            counts.into_iter().map(|count| count as f32).collect()
        }
    };
    Some(work)
}

/// Writes the layers of frames of one size.
pub(super) fn write(layers: &[Layer], camera: &Camera, out: impl Write + Seek) -> io::Result<()> {
    let Some(first) = layers.first() else { return Ok(()) };
    let mut channels: Vec<Channel> =
        layers.iter().flat_map(|layer| channels(layer, camera)).collect();
    // A file lists its channels by their bytes.
    channels.sort_by(|a, b| a.name.cmp(&b.name));
    let header = header(first.frame, &channels);
    let width = first.frame.width();
    let written = write_blocks(out, vec![header].into(), true, |meta, writer| {
        fill(&meta, writer, &channels, width)
    });
    written.map_err(|error| match error {
        Error::Io(error) => error,
        other => io::Error::other(other.to_string()),
    })
}

/// Compresses and writes all blocks, in the order of the file.
fn fill<W: Write + Seek>(
    meta: &MetaData,
    writer: &mut ChunkWriter<W>,
    channels: &[Channel],
    width: usize,
) -> UnitResult {
    let blocks: Vec<(usize, BlockIndex)> =
        enumerate_ordered_header_block_indices(&meta.headers).collect();
    for blocks in blocks.chunks(AT_ONCE) {
        let compressed = |&(number, index): &(usize, BlockIndex)| {
            let block = UncompressedBlock::from_lines(&meta.headers[0].channels, index, |line| {
                put(line, channels, width);
            });
            block.compress_to_chunk(&meta.headers).map(|chunk| (number, chunk))
        };
        let chunks: Vec<_> = blocks.par_iter().map(compressed).collect();
        for chunk in chunks {
            let (number, chunk): (usize, Chunk) = chunk?;
            writer.write_chunk(number, chunk)?;
        }
    }
    Ok(())
}

/// Stores one line of one channel.
fn put(line: LineRefMut, channels: &[Channel], width: usize) {
    let Vec2(column, row) = line.location.position;
    let first = row * width + column;
    let stored = match &channels[line.location.channel].values {
        Values::Integers(values) => line.write_samples(|place| values[first + place]),
        Values::Floats(value) => line.write_samples(|place| value(first + place)),
    };
    stored.expect("a line has room for its samples");
}

/// The header of a file with these channels: its data window is the part of the image that the frame holds, its display
/// window all of the image, in samples.
fn header(frame: &Frame, channels: &[Channel]) -> Header {
    let described = channels.iter().map(|channel| {
        let kind = match channel.values {
            Values::Integers(_) => SampleType::U32,
            Values::Floats(_) => SampleType::F32,
        };
        ChannelDescription::named(channel.name.as_str(), kind)
    });
    let Region { rows, columns } = frame.region();
    let start = |from: usize| i32::try_from(from).expect("a side has fewer samples");
    let whole = frame.camera_image().map(|side| (side * frame.samples()) as usize);
    let mut header = Header::new(
        Text::from("bothways"),
        (columns.len(), rows.len()),
        described.collect::<Vec<_>>().into(),
    )
    .with_encoding(Compression::ZIP16, BlockDescription::ScanLines, LineOrder::Increasing)
    .with_position(Vec2(start(columns.start), start(rows.start)))
    .with_display_window(IntegerBounds::from_dimensions((whole[0], whole[1])));
    let wide = if frame.ids().narrow().is_some() { "" } else { WIDE_IDS };
    header.own_attributes.comments = Some(Text::from(format!("{COMMENT}{wide}").as_str()));
    header.own_attributes.software_name = Some(Text::from("bothways"));
    header
}

/// A channel: its full name, and its values in the order of a frame's samples.
struct Channel<'a> {
    name: String,
    values: Values<'a>,
}

enum Values<'a> {
    Integers(Cow<'a, [u32]>),
    Floats(Box<dyn Fn(usize) -> f32 + Sync + 'a>),
}

/// The channels of one order.
fn channels<'a>(layer: &Layer<'a>, camera: &Camera) -> Vec<Channel<'a>> {
    let Layer { order, frame, work } = *layer;
    let layer = match order {
        Order::Object => "object",
        Order::Image => "image",
    };
    let (ids, t, colors, normals) =
        (frame.ids(), frame.distances(), frame.colors(), frame.normals());
    let name = |name: &str| format!("{layer}.{name}");
    let float = |part: &str, value: Box<dyn Fn(usize) -> f32 + Sync + 'a>| Channel {
        name: name(part),
        values: Values::Floats(value),
    };
    let ray = match camera.projection() {
        Projection::Perspective => camera.distance(),
        Projection::Parallel => 1.0,
    };
    let mut channels = vec![
        float("t", Box::new(move |at| t[at])),
        #[expect(clippy::cast_possible_truncation, reason = "a depth is stored as `t` is")]
        float("depth.Z", Box::new(move |at| (f64::from(t[at]) * ray) as f32)),
        float("coverage", Box::new(move |at| if t[at].is_finite() { 1.0 } else { 0.0 })),
    ];
    let integers =
        |part: &str, values| Channel { name: name(part), values: Values::Integers(values) };
    match ids {
        Ids::Narrow(ids) => channels.push(integers("id", Cow::Borrowed(ids))),
        Ids::Wide(ids) => {
            #[expect(clippy::cast_possible_truncation, reason = "the two halves of 64 bits")]
            let halves = [0, 32].map(|from| ids.iter().map(|id| (id >> from) as u32).collect());
            let parts = halves.into_iter().zip(["id", "id_high"]);
            channels.extend(parts.map(|(half, part)| integers(part, Cow::Owned(half))));
        }
    }
    for (axis, [color, normal]) in [["R", "X"], ["G", "Y"], ["B", "Z"]].into_iter().enumerate() {
        let part = move |at: usize| linear_from_srgb(color_of_id(ids.get(at))[axis]);
        channels.push(float(color, Box::new(move |at| colors[at][axis])));
        channels.push(float(&format!("id_color.{color}"), Box::new(part)));
        channels.push(float(&format!("normal.{normal}"), Box::new(move |at| normals[at][axis])));
    }
    channels.extend(work.map(|work| float("work", Box::new(move |at| work[at]))));
    channels
}
