//! EXR pictures of any origin: colours, ids, distances and normals in channels that are chosen by name.

use super::channels::{Channel, Choice, Meaning, choose, listed, with_high_half};
use super::picture::MOST_MEMORY;
use super::read_buffer::{ReadBuffer, ReadOptions};
use super::{Content, Covered, Picture, Pixels, normals};
use crate::common::raster::check_samples;
use crate::diff::buffer::Buffer;
use crate::formats::picture::{Problem, ends_early};
use crate::formats::source::quote::{shown, visible};
use ::exr::block::chunk::Chunk;
use ::exr::block::lines::LineRef;
use ::exr::block::reader::{ChunksReader, Reader};
use ::exr::block::{UncompressedBlock, read as open};
use ::exr::compression::Compression;
use ::exr::error::Error;
use ::exr::math::Vec2;
use ::exr::meta::attribute::{SampleType, Text};
use ::exr::meta::header::Header;
use ::exr::meta::{BlockDescription, MetaData};
use ::exr::prelude::f16;
use std::io::{Read, Seek};

/// The first bytes of every EXR file.
pub(super) const MAGIC: &[u8] = &[0x76, 0x2f, 0x31, 0x01];
/// The most bytes that one byte of a compressed file can stand for: a run of zip takes two bits for 258 bytes.
const LONGEST_RUN: u64 = 1032;

/// Reads the chosen channels; messages about them name all channels of the file.
pub(super) fn read(
    input: impl Read + Seek,
    length: u64,
    options: &ReadOptions,
) -> Result<ReadBuffer, Problem> {
    let told = |error| problem(&error, length);
    let reader = open(input, false).map_err(told)?;
    let parts = ExrChannel::all(reader.meta_data());
    let all: Vec<Channel> = parts.iter().map(|part| part.channel.clone()).collect();
    let choice = with_high_half(choose(&all, &options.channels, options.normals)?, &all);
    let chosen: Vec<&ExrChannel> = choice.channels.iter().map(|&at| &parts[at]).collect();
    let layer = chosen[0].layer;
    if chosen.iter().any(|part| part.layer != layer) {
        return Err(Problem::Content(format!(
            "the channels {} are not in one part of the file; choose channels of one part",
            listed(&choice, &all)
        )));
    }
    let header = &reader.meta_data().headers[layer];
    let size = size(header)?;
    check_header(header, size, length, chosen.len() as u64)?;
    let mut notes = vec![notes(&choice, &all)];
    notes.extend(crop(header));
    let places: Vec<usize> = chosen.iter().map(|part| part.place).collect();
    let values = Values::read(reader, layer, size, &places).map_err(told)?;
    let Some(values) = values else { return Err(Problem::Content(ends_early(length))) };
    let content = content(values, &choice, size, options)?;
    Ok(ReadBuffer { notes, ..Buffer::new(size, 1, content).into() })
}

/// `its channels R, G, B; not read: Z`.
fn notes(choice: &Choice, all: &[Channel]) -> String {
    let of = if choice.channels.len() == 1 { "channel" } else { "channels" };
    let left = (0..all.len()).filter(|at| !choice.channels.contains(at)).collect();
    let left = Choice { channels: left, ..*choice };
    match left.channels.len() {
        0 => format!("{of} {}", listed(choice, all)),
        1..=16 => format!("{of} {}; not read: {}", listed(choice, all), listed(&left, all)),
        more => format!("{of} {}; {more} more are not read", listed(choice, all)),
    }
}

/// A channel and its place: which layer of the file, and which channel of that.
struct ExrChannel {
    channel: Channel,
    layer: usize,
    place: usize,
}

impl ExrChannel {
    /// All channels of all layers, in the order of the file.
    fn all(meta: &MetaData) -> Vec<ExrChannel> {
        let parts = |(layer, header): (usize, &Header)| -> Vec<ExrChannel> {
            let name = header.own_attributes.layer_name.as_ref().map(Text::to_string);
            let prefix = name.filter(|name| meta.headers.len() > 1 && !name.is_empty());
            let full = |name: &Text| match &prefix {
                Some(prefix) => format!("{prefix}.{name}"),
                None => name.to_string(),
            };
            let channels = header.channels.list.iter().enumerate();
            channels
                .map(|(place, channel)| ExrChannel {
                    channel: Channel {
                        name: full(&channel.name),
                        is_integer: channel.sample_type == SampleType::U32,
                    },
                    layer,
                    place,
                })
                .collect()
        };
        meta.headers.iter().enumerate().flat_map(parts).collect()
    }
}

/// The size of the picture, or of the part of it that the file holds.
fn size(header: &Header) -> Result<[u32; 2], Problem> {
    let (data, shown) = (header.data_window(), header.shared_attributes.display_window);
    let side = |length: usize| u32::try_from(length).unwrap_or(u32::MAX);
    let size = [side(data.size.0), side(data.size.1)];
    check_samples(size, 1)?;
    // A data window within the display window is a crop: its own pixels are read, and the notes say where they lie.
    if !shown.contains(data) {
        let place = |window: ::exr::meta::attribute::IntegerBounds| {
            let (Vec2(x, y), Vec2(width, height)) = (window.position, window.size);
            format!("{width} x {height} from ({y}, {x}) on")
        };
        return Err(Problem::Content(format!(
            "its data window ({}) is not its display window ({}), and reaches beyond it, so that pixels are too many; \
             save it without overscan",
            place(data),
            place(shown)
        )));
    }
    Ok(size)
}

/// Which part of the picture the file holds, if not all of it.
fn crop(header: &Header) -> Option<String> {
    let (data, shown) = (header.data_window(), header.shared_attributes.display_window);
    let Vec2(column, row) = data.position - shown.position;
    let Vec2(width, height) = shown.size;
    let whole = format!("its crop at ({row}, {column}) of {width} x {height}");
    (data != shown).then_some(whole)
}

/// Refuses what the library cannot decode, and sizes that the file cannot fill or that fill too much memory.
fn check_header(
    header: &Header,
    [width, height]: [u32; 2],
    length: u64,
    chosen: u64,
) -> Result<(), String> {
    if let Some(channel) = header.channels.list.iter().find(|one| one.sampling != Vec2(1, 1)) {
        return Err(format!(
            "its channel {} has fewer samples than pixels (subsampling), which is not read; save it as \
             red, green and blue",
            shown(&channel.name.to_string())
        ));
    }
    let pixels = u64::from(width) * u64::from(height);
    let raw = pixels.saturating_mul(header.channels.bytes_per_pixel as u64);
    let longest = if header.compression == Compression::Uncompressed { 1 } else { LONGEST_RUN };
    if raw > length.saturating_mul(longest) {
        return Err(format!(
            "an EXR of {length} bytes cannot fill {width} x {height} pixels of {} channels; if the file is \
             complete, save it with zip compression",
            header.channels.list.len()
        ));
    }
    let block = match header.blocks {
        BlockDescription::Tiles(tiles) => {
            let Vec2(across, down) = tiles.tile_size;
            (across as u64).saturating_mul(down as u64)
        }
        BlockDescription::ScanLines => {
            u64::from(width) * header.compression.scan_lines_per_block() as u64
        }
    };
    // A block as it is stored and as it is decoded, the chosen values, and the buffer that they become.
    let block = block.saturating_mul(2 * header.channels.bytes_per_pixel as u64);
    let needed = block.saturating_add(pixels * (4 * chosen + 16));
    if needed > MOST_MEMORY {
        return Err(format!(
            "its {width} x {height} pixels need {} MiB of memory, and a picture may take {}; compare parts \
             of it, or save it in smaller tiles",
            needed.div_ceil(1 << 20),
            MOST_MEMORY >> 20
        ));
    }
    Ok(())
}

/// The values of some channels, each row by row.
enum Values {
    Floats(Vec<Vec<f32>>),
    /// One channel of integers, or the halves of integers of 64 bits.
    Integers(Vec<Vec<u32>>),
}

impl Values {
    /// Reads block after block; `None` if some are missing.
    fn read(
        reader: Reader<impl Read + Seek>,
        layer: usize,
        [width, height]: [u32; 2],
        places: &[usize],
    ) -> Result<Option<Values>, Error> {
        let (width, count) = (width as usize, width as usize * height as usize);
        let list = reader.meta_data().headers[layer].channels.clone();
        let types: Vec<SampleType> = list.list.iter().map(|channel| channel.sample_type).collect();
        let mut values = match (places, types[places[0]]) {
            ([_] | [_, _], SampleType::U32) => Values::Integers(vec![vec![0; count]; places.len()]),
            _ => Values::Floats(vec![vec![0.0; count]; places.len()]),
        };
        let mut missing = count;
        let mut chunks = reader.all_chunks(false)?;
        while let Some(chunk) = chunks.read_next_chunk() {
            let chunk: Chunk = chunk?;
            if chunk.layer_index != layer {
                continue;
            }
            let block = UncompressedBlock::decompress_chunk(chunk, chunks.meta_data(), false)?;
            if block.index.level != Vec2(0, 0) {
                continue;
            }
            missing = missing.saturating_sub(block.index.pixel_size.area());
            for line in block.lines(&list) {
                let Some(target) = places.iter().position(|&place| place == line.location.channel)
                else {
                    continue;
                };
                let Vec2(column, row) = line.location.position;
                let start = row * width + column;
                let place = start..start + line.location.sample_count;
                values.put(&line, types[line.location.channel], target, place)?;
            }
        }
        Ok((missing == 0).then_some(values))
    }

    /// Stores a line of a channel.
    fn put(
        &mut self,
        line: &LineRef,
        kind: SampleType,
        target: usize,
        place: std::ops::Range<usize>,
    ) -> Result<(), Error> {
        let floats = match self {
            Values::Integers(halves) => {
                for (value, read) in
                    halves[target][place].iter_mut().zip(line.read_samples::<u32>())
                {
                    *value = read?;
                }
                return Ok(());
            }
            Values::Floats(channels) => &mut channels[target][place],
        };
        if kind == SampleType::F16 {
            for (value, read) in floats.iter_mut().zip(line.read_samples::<f16>()) {
                *value = read?.to_f32();
            }
        } else {
            for (value, read) in floats.iter_mut().zip(line.read_samples::<f32>()) {
                *value = read?;
            }
        }
        Ok(())
    }
}

/// The chosen values as the content of a buffer.
fn content(
    values: Values,
    choice: &Choice,
    [width, _]: [u32; 2],
    options: &ReadOptions,
) -> Result<Content<'static>, String> {
    let channels = match values {
        Values::Integers(halves) => return Ok(Content::Ids(joined(&halves))),
        Values::Floats(channels) => channels,
    };
    let place = |pixel: usize| format!("({}, {})", pixel / width as usize, pixel % width as usize);
    Ok(match choice.meaning {
        Meaning::Ids => Content::Ids(ids(&channels[0], place)?),
        Meaning::Distances => {
            Content::Distances(channels[0].iter().map(|&t| f64::from(t)).collect())
        }
        Meaning::Normals => Content::Normals(vectors(&channels)),
        Meaning::Colors if channels.len() == 3 && normals::are_normals(vectors(&channels)) => {
            Content::Normals(vectors(&channels))
        }
        Meaning::Colors | Meaning::Grey => picture(&channels, options.background, place)?,
    })
}

/// Ids of 32 bits, or of 64 in two halves; all ones are nothing.
fn joined(halves: &[Vec<u32>]) -> Vec<Option<u64>> {
    let low = halves[0].iter().map(|&low| u64::from(low));
    match halves.get(1) {
        None => low.map(|id| (id != u64::from(u32::MAX)).then_some(id)).collect(),
        Some(high) => {
            let ids = low.zip(high).map(|(low, &high)| low | u64::from(high) << 32);
            ids.map(|id| (id != u64::MAX).then_some(id)).collect()
        }
    }
}

fn vectors(channels: &[Vec<f32>]) -> Vec<[f32; 3]> {
    let [x, y, z] = [0, 1, 2].map(|axis| channels[axis].iter());
    x.zip(y).zip(z).map(|((&x, &y), &z)| [x, y, z]).collect()
}

/// Ids that are stored as floats, as some programs do.
fn ids(values: &[f32], place: impl Fn(usize) -> String) -> Result<Vec<Option<u64>>, String> {
    /// Up to here, a float holds every whole number.
    const LARGEST: f32 = 16_777_216.0;
    let id = |(pixel, &value): (usize, &f32)| {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a whole number"
        )]
        match value {
            -1.0 | f32::INFINITY => Ok(None),
            value if value.fract() == 0.0 && (0.0..=LARGEST).contains(&value) => {
                Ok(Some(value as u64))
            }
            value => Err(format!(
                "the id at {} is {value}; ids are whole numbers from 0 (and floats hold them up to \
                 {LARGEST}); save them in a channel of integers, or choose another with --channels",
                place(pixel)
            )),
        }
    };
    values.iter().enumerate().map(id).collect()
}

/// A mask of two values, or a picture in sRGB: colours in an EXR are linear, and multiplied by alpha.
fn picture(
    channels: &[Vec<f32>],
    background: Option<[u8; 3]>,
    place: impl Fn(usize) -> String,
) -> Result<Content<'static>, String> {
    let count = channels[0].len();
    for pixel in 0..count {
        if let Some(value) = channels.iter().map(|channel| channel[pixel]).find(|v| !v.is_finite())
        {
            return Err(format!(
                "the colour at {} is {value}; colours are finite numbers; choose other channels with \
                 --channels, or mend the picture",
                place(pixel)
            ));
        }
    }
    if let [grey] = channels {
        let lit = grey.iter().copied().find(|&value| value != 0.0).unwrap_or_default();
        if grey.iter().all(|&value| value == 0.0 || value == lit) {
            let mask: Vec<bool> = grey.iter().map(|&value| value != 0.0).collect();
            return Ok(Content::Mask(mask.into()));
        }
    }
    let pixel = |at: usize| {
        let alpha = channels.get(3).map_or(1.0, |alpha| alpha[at]);
        let parts = if alpha > 0.0 { alpha } else { 1.0 };
        let color = |channel: usize| {
            let grey = channel.min(channels.len() - 1);
            srgb_steps(f64::from(channels[grey][at]) / f64::from(parts))
        };
        [color(0), color(1), color(2), alpha * 255.0]
    };
    let covered = match (channels.len(), background) {
        (1, _) => Covered::ByLight,
        (4, _) => Covered::ByAlpha,
        (_, Some(background)) => Covered::ByBackground(background),
        (_, None) => Covered::Unknown,
    };
    let pixels = Pixels::Steps((0..count).map(pixel).collect());
    Ok(Content::Picture(Picture { pixels, covered }))
}

/// Linear light in the 255 steps of sRGB (IEC 61966-2-1). The curve goes on beyond white, and below black as the mirror
/// image, so that no difference is cut off.
fn srgb_steps(linear: f64) -> f32 {
    let size = linear.abs();
    let encoded =
        if size <= 0.003_130_8 { 12.92 * size } else { 1.055 * size.powf(1.0 / 2.4) - 0.055 };
    #[expect(clippy::cast_possible_truncation, reason = "far finer than the tolerance")]
    let steps = (255.0 * encoded.copysign(linear)) as f32;
    steps
}

/// The message of the decoder in our words.
fn problem(error: &Error, length: u64) -> Problem {
    let short = |said: &str| visible(&said.chars().take(100).collect::<String>()).into_owned();
    match error {
        Error::Io(error) => match error.kind() {
            std::io::ErrorKind::UnexpectedEof => Problem::Content(ends_early(length)),
            _ => Problem::Io(std::io::Error::new(error.kind(), error.to_string())),
        },
        // The decoder says so where the file ends.
        Error::Invalid(said) if said.contains("missing bytes") => {
            Problem::Content(ends_early(length))
        }
        Error::NotSupported(said) => Problem::Content(format!(
            "this kind of EXR is not read ({}); save it flat, with zip compression",
            short(said)
        )),
        Error::Invalid(said) => Problem::Content(format!(
            "the EXR is damaged ({}); copy it or save it again",
            short(said)
        )),
        Error::Aborted => Problem::Content("the EXR is damaged; save it again".into()),
    }
}
