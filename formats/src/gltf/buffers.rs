//! The data of a glTF file's buffers: in the file, in a `data:` URI, or in a file beside it.

use super::error::GltfFault;
use super::item::{Located, item};
use crate::source::Files;
use ::gltf::json::{Buffer, Index, Root, buffer};
use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// The data of all buffers.
pub(super) struct Buffers<'a> {
    data: Vec<Data<'a>>,
    /// The content of files, each once.
    files: Vec<Cow<'a, [u8]>>,
}

/// The data of a buffer: its own, or the index of a file.
enum Data<'a> {
    Own(Cow<'a, [u8]>),
    File(usize),
}

/// Where the bytes of an image are.
pub(super) enum Image {
    Own(Vec<u8>),
    /// In a file of this name.
    File(String),
    /// The URI can be no path.
    NoFile,
}

/// Part of a buffer.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    pub(super) bytes: &'a [u8],
    /// The place of its first byte in its buffer.
    pub(super) offset: u64,
    pub(super) stride: Option<usize>,
}

impl<'a> Buffers<'a> {
    /// Reads all buffers.
    pub(super) fn read(
        root: &Root,
        bin: Option<&'a [u8]>,
        files: &Files<'a>,
    ) -> Result<Buffers<'a>, Located> {
        let mut known = BTreeMap::new();
        let mut buffers = Buffers { data: Vec::new(), files: Vec::new() };
        for (index, buffer) in root.buffers.iter().enumerate() {
            let located = |fault| (format!("buffer {index}"), fault);
            let data = match (&buffer.uri, bin.filter(|_| index == 0)) {
                (None, Some(bin)) => Data::Own(bin.into()),
                (None, None) => return Err(located(GltfFault::NoData)),
                (Some(uri), _) => buffers.of_uri(uri, files, &mut known).map_err(located)?,
            };
            buffers.data.push(data);
            buffers.check_length(buffer, index).map_err(located)?;
        }
        Ok(buffers)
    }

    /// The content of an image's URI: its own, or a picture in a file.
    pub(super) fn image(uri: &str) -> Result<Image, GltfFault> {
        if let Some(data) = strip_scheme(uri, "data:") {
            return Ok(Image::Own(decoded(data)?));
        }
        Ok(percent_decoded(uri).map_or(Image::NoFile, Image::File))
    }

    fn of_uri(
        &mut self,
        uri: &str,
        files: &Files<'a>,
        known: &mut BTreeMap<PathBuf, usize>,
    ) -> Result<Data<'a>, GltfFault> {
        if let Some(data) = strip_scheme(uri, "data:") {
            return Ok(Data::Own(decoded(data)?.into()));
        }
        let name = percent_decoded(uri)
            .ok_or_else(|| GltfFault::Uri { uri: uri.to_owned(), help: "it is no path" })?;
        let file = files.find(&name).map_err(|error| GltfFault::NamedFile { error })?;
        if let Some(&file) = known.get(file.identity()) {
            return Ok(Data::File(file));
        }
        let read = file.beginning(u32::MAX.into());
        let read = read.map_err(|error| GltfFault::BufferFile { name: uri.to_owned(), error })?;
        known.insert(file.identity().to_owned(), self.files.len());
        self.files.push(read);
        Ok(Data::File(self.files.len() - 1))
    }

    fn bytes(&self, buffer: usize) -> &[u8] {
        match &self.data[buffer] {
            Data::Own(bytes) => bytes,
            Data::File(file) => &self.files[*file],
        }
    }

    /// Makes sure that a buffer has as much data as it states, perhaps with padding behind it.
    fn check_length(&self, buffer: &Buffer, index: usize) -> Result<(), GltfFault> {
        let (stated, found) = (buffer.byte_length.0, self.bytes(index).len() as u64);
        if stated <= found { Ok(()) } else { Err(GltfFault::BufferLength { stated, found }) }
    }

    /// The bytes of all buffers together.
    pub(super) fn length(&self) -> u64 {
        (0..self.data.len()).map(|buffer| self.bytes(buffer).len() as u64).sum()
    }

    /// The view that an accessor names.
    pub(super) fn view(
        &self,
        root: &Root,
        index: Index<buffer::View>,
    ) -> Result<View<'_>, Located> {
        let (number, view) =
            item(&root.buffer_views, index, "view").map_err(|f| (String::new(), f))?;
        let located = |fault| (format!("view {number}"), fault);
        let (buffer, stated) = item(&root.buffers, view.buffer, "buffer").map_err(located)?;
        let offset = view.byte_offset.map_or(0, |offset| offset.0);
        let (end, length) =
            (u128::from(offset) + u128::from(view.byte_length.0), stated.byte_length.0);
        if end > u128::from(length) {
            return Err(located(GltfFault::ViewTooLong { end, length }));
        }
        let stride = view.byte_stride.map(|stride| stride.0);
        if let Some(stride) =
            stride.filter(|&stride| stride % 4 != 0 || !(4..=252).contains(&stride))
        {
            return Err(located(GltfFault::Stride { stride }));
        }
        // The end is within the buffer, so both fit.
        #[expect(clippy::cast_possible_truncation, reason = "within the buffer")]
        let bytes = &self.bytes(buffer)[offset as usize..end as usize];
        Ok(View { bytes, offset, stride })
    }
}

/// What follows a scheme, which is written in letters of any case.
fn strip_scheme<'u>(uri: &'u str, scheme: &str) -> Option<&'u str> {
    let (begin, rest) = uri.split_at_checked(scheme.len())?;
    begin.eq_ignore_ascii_case(scheme).then_some(rest)
}

/// The data of a URI behind `data:`.
fn decoded(uri: &str) -> Result<Vec<u8>, GltfFault> {
    let refused = |help| GltfFault::Uri { uri: format!("data:{uri}"), help };
    let data = uri.split_once(',').filter(|(kind, _)| kind.ends_with(";base64"));
    let (_, data) = data.ok_or_else(|| refused("data must be in base64"))?;
    let config =
        GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent);
    let decoded = GeneralPurpose::new(&STANDARD, config).decode(data);
    decoded.map_err(|_| refused("its data is no base64"))
}

/// The text that a URI stands for; `None` if it is none.
fn percent_decoded(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&byte, after)) = rest.split_first() {
        rest = after;
        if byte == b'%' {
            let (digits, after) = rest.split_at_checked(2)?;
            let digit = |k: usize| char::from(digits[k]).to_digit(16);
            bytes.push(u8::try_from(16 * digit(0)? + digit(1)?).ok()?);
            rest = after;
        } else {
            bytes.push(byte);
        }
    }
    String::from_utf8(bytes).ok().filter(|name| !name.contains('\0'))
}
