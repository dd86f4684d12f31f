//! Reads pictures as textures.

use super::{Problem, open};
use crate::source::{Files, FindFileError, Unreadable};
use crate::warning::{MaterialWarning, Missing};
use bothways_common::look::color::{linear_from_encoded, linear_from_srgb};
use bothways_common::scene::Pyramid;
use glam::Vec3;
use image::{DynamicImage, ImageFormat};
use std::collections::BTreeMap;
use std::io::{self, BufRead, Cursor, Read, Seek, SeekFrom};
use std::path::PathBuf;
use std::sync::Arc;

/// Why a picture cannot be read as a texture.
#[derive(Debug, thiserror::Error)]
pub enum ReadTextureError {
    /// There is no such file, or it may not be read.
    #[error(transparent)]
    Find(#[from] FindFileError),
    /// The file is a folder or a pipe, or the system reports another error.
    #[error("{file}: {}", Unreadable::new(.error, "a picture"))]
    Unreadable {
        /// The file.
        file: String,
        /// The system's error. The message contains it, so it is not a [source](std::error::Error::source) as well.
        error: io::Error,
    },
    /// The first bytes of the file belong to no known format.
    #[error("{file} is no picture (PNG, JPEG, BMP or PNM); save it as one of these")]
    NotAPicture {
        /// The file.
        file: String,
    },
    /// All textures of a file together have too many pixels.
    #[error(
        "{file}: it has {width} x {height} pixels; the textures of a file may have {MOST_TEXELS} together, and {left} are \
         left: make it smaller"
    )]
    TooLarge {
        /// The picture.
        file: String,
        /// Its width in pixels, as its header states it.
        width: u32,
        /// Its height in pixels.
        height: u32,
        /// How many pixels the other textures leave.
        left: u64,
    },
    /// The file is damaged, or of a kind that is not read.
    #[error("{file}: {problem}")]
    Content {
        /// The file.
        file: String,
        /// What is wrong, and the remedy.
        problem: String,
    },
}

/// The most pixels of all textures of a file together: as floats, and with their smaller levels, they take 2 GiB.
const MOST_TEXELS: u64 = 1 << 27;
/// The most memory that decoding takes: so many pixels of four channels of 16 bits, and as coefficients of a JPEG.
const MOST_MEMORY: u64 = MOST_TEXELS * 16;

/// The pictures that a file names, each read once.
pub(crate) struct Pictures {
    known: BTreeMap<PathBuf, Arc<Pyramid>>,
    /// The names of those that are not there, with the first line that names each.
    missing: BTreeMap<Missing, BTreeMap<String, Option<usize>>>,
    left: u64,
}

impl Default for Pictures {
    fn default() -> Self {
        Pictures { known: BTreeMap::new(), missing: BTreeMap::new(), left: MOST_TEXELS }
    }
}

impl Pictures {
    /// Reads the picture of a name.
    pub(crate) fn of_file(
        &mut self,
        files: &Files,
        name: &str,
    ) -> Result<Arc<Pyramid>, ReadTextureError> {
        let file = files.find(name)?;
        if let Some(known) = self.known.get(file.identity()) {
            return Ok(Arc::clone(known));
        }
        let unreadable = |error| ReadTextureError::Unreadable { file: file.name(), error };
        let pyramid = self.read(&file.name(), file.open().map_err(unreadable)?)?;
        self.known.insert(file.identity().to_owned(), Arc::clone(&pyramid));
        Ok(pyramid)
    }

    /// Reads a picture from its bytes, which messages call `name`.
    pub(crate) fn of_bytes(
        &mut self,
        name: &str,
        bytes: &[u8],
    ) -> Result<Arc<Pyramid>, ReadTextureError> {
        self.read(name, Cursor::new(bytes))
    }

    /// Reads the picture of a name as [`Pictures::of_file`] does, and notes its name if it is not there.
    pub(crate) fn find(
        &mut self,
        files: &Files,
        name: &str,
    ) -> Result<Option<Arc<Pyramid>>, ReadTextureError> {
        let read = self.of_file(files, name);
        if let Err(ReadTextureError::Find(error)) = &read
            && let Some(why) = error.missing()
        {
            self.miss(name, why, None);
            return Ok(None);
        }
        read.map(Some)
    }

    /// Notes that a picture is missing, which a line names.
    pub(crate) fn miss(&mut self, name: &str, why: Missing, line: Option<usize>) {
        self.missing.entry(why).or_default().entry(name.to_owned()).or_insert(line);
    }

    /// Warnings about those that are missing, for a file that names them.
    pub(crate) fn warnings(&self, file: &str) -> impl Iterator<Item = MaterialWarning> {
        self.missing.iter().map(|(&why, names)| {
            let line = names.values().copied().flatten().min();
            let names = names.keys().cloned().collect();
            MaterialWarning::MissingPictures { file: file.to_owned(), line, names, why }
        })
    }

    /// Reads a picture, if there is room for it.
    fn read(
        &mut self,
        file: &str,
        mut input: impl BufRead + Seek,
    ) -> Result<Arc<Pyramid>, ReadTextureError> {
        let file = || file.to_owned();
        let wrong = |problem| match problem {
            Problem::Content(problem) => ReadTextureError::Content { file: file(), problem },
            Problem::Size(error) => {
                ReadTextureError::Content { file: file(), problem: error.to_string() }
            }
            Problem::Memory => ReadTextureError::Content {
                file: file(),
                problem: "decoding it needs too much memory; save it as PNG, or make it smaller"
                    .to_owned(),
            },
            Problem::Io(error) => ReadTextureError::Unreadable { file: file(), error },
        };
        let (start, length) = start(&mut input).map_err(|error| wrong(error.into()))?;
        let format = image::guess_format(&start).ok().filter(|format| format.reading_enabled());
        let Some(format) = format else {
            return Err(ReadTextureError::NotAPicture { file: file() });
        };
        let opened = open(input, length, format, MOST_MEMORY).map_err(wrong)?;
        let ([width, height], left) = (opened.size(), self.left);
        let texels = u64::from(width) * u64::from(height);
        if texels == 0 {
            let problem = format!("it has {width} x {height} pixels; save it again");
            return Err(ReadTextureError::Content { file: file(), problem });
        }
        if texels > left {
            return Err(ReadTextureError::TooLarge { file: file(), width, height, left });
        }
        let picture = opened.decode().map_err(wrong)?;
        self.left -= texels;
        Ok(Arc::new(Pyramid::new(width as usize, linear(picture))))
    }
}

/// Whether the name of a file is that of a picture in a format that is read.
pub(crate) fn has_known_ending(name: &str) -> bool {
    ImageFormat::from_path(name).is_ok_and(|format| format.reading_enabled())
}

/// The first bytes of an input, which determine the format, and the length of the input.
fn start(input: &mut (impl BufRead + Seek)) -> io::Result<(Vec<u8>, u64)> {
    let length = input.seek(SeekFrom::End(0))?;
    input.rewind()?;
    let mut start = Vec::new();
    input.by_ref().take(32).read_to_end(&mut start)?;
    input.rewind()?;
    Ok((start, length))
}

/// The texels of a picture in linear light. Its values are taken for sRGB, whatever profile it states; alpha is dropped.
///
/// This is the one place where a texture is decoded: what is averaged, blended and multiplied later is linear.
fn linear(picture: DynamicImage) -> Vec<Vec3> {
    let is_fine = picture.color().bytes_per_pixel() > picture.color().channel_count();
    if is_fine {
        let of = |value: u16| linear_from_encoded(f32::from(value) / 65535.0);
        let colors = picture.into_rgb16();
        return colors.pixels().map(|pixel| Vec3::from_array(pixel.0.map(of))).collect();
    }
    let table: Vec<f32> = (0..=255).map(linear_from_srgb).collect();
    let of = |value: u8| table[usize::from(value)];
    picture.into_rgb8().pixels().map(|pixel| Vec3::from_array(pixel.0.map(of))).collect()
}
