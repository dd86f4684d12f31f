//! The textures of materials: pictures in views, in `data:` URIs, or in files beside the file.

use super::buffers::{Buffers, Image};
use super::error::GltfFault;
use super::item::item;
use crate::picture::texture::Pictures;
use crate::source::Files;
use crate::warning::{MaterialWarning, Missing};
use ::gltf::json::texture::{self, Info, MagFilter, MinFilter, WrappingMode};
use ::gltf::json::validation::Checked;
use ::gltf::json::{Root, image};
use bothways_common::scene::{Filter, Levels, Pyramid, Sampler, Texture, Wrap};
use glam::{DAffine2, DMat2, DVec2, Vec2};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The pictures of a file, each read once.
pub(super) struct Textures<'a> {
    root: &'a Root,
    buffers: &'a Buffers<'a>,
    files: &'a Files<'a>,
    pictures: Pictures,
    /// For each image that was asked for, its picture, if there is one.
    known: BTreeMap<usize, Option<Arc<Pyramid>>>,
    /// Whether a texture is of an extension alone.
    has_others: bool,
}

impl<'a> Textures<'a> {
    pub(super) fn new(root: &'a Root, buffers: &'a Buffers<'a>, files: &'a Files<'a>) -> Self {
        let (pictures, known) = (Pictures::default(), BTreeMap::new());
        Textures { root, buffers, files, pictures, known, has_others: false }
    }

    /// The texture that a material names; `None` if its picture is missing.
    pub(super) fn of(&mut self, info: &Info) -> Result<Option<Texture>, GltfFault> {
        let (_, texture) = item(&self.root.textures, info.index, "texture")?;
        let sampler = match texture.sampler {
            Some(index) => sampler(item(&self.root.samplers, index, "sampler")?.1)?,
            // The format leaves this to us.
            None => Sampler::MIPMAPS,
        };
        // What the JSON reader makes of a texture without an image.
        if texture.source.value() == u32::MAX as usize {
            self.has_others = true;
            return Ok(None);
        }
        let (number, image) = item(&self.root.images, texture.source, "image")?;
        let pyramid = match self.known.get(&number) {
            Some(known) => known.clone(),
            None => self.read(number, image)?,
        };
        self.known.insert(number, pyramid.clone());
        Ok(pyramid.map(|pyramid| Texture { pyramid, sampler }))
    }

    fn read(
        &mut self,
        number: usize,
        image: &image::Image,
    ) -> Result<Option<Arc<Pyramid>>, GltfFault> {
        const NAME: &str = "its data";
        let wrong = |error| GltfFault::Picture { image: number, error };
        if let Some(index) = image.buffer_view {
            let view = self.buffers.view(self.root, index).map_err(|(_, fault)| fault)?;
            return self.pictures.of_bytes(NAME, view.bytes).map(Some).map_err(wrong);
        }
        let uri = image.uri.as_deref().ok_or(GltfFault::NoImage { image: number })?;
        match Buffers::image(uri)? {
            Image::Own(bytes) => self.pictures.of_bytes(NAME, &bytes).map(Some).map_err(wrong),
            Image::File(name) => self.pictures.find(self.files, &name).map_err(wrong),
            Image::NoFile => {
                self.pictures.miss(uri, Missing::Absent, None);
                Ok(None)
            }
        }
    }

    /// Warnings about pictures that are missing, or of a kind that is not read.
    pub(super) fn warnings(&self, file: &str) -> impl Iterator<Item = MaterialWarning> {
        let others = || MaterialWarning::Textures { file: file.to_owned() };
        self.pictures.warnings(file).chain(self.has_others.then(others))
    }
}

/// Which texture coordinates of a primitive a texture uses, and how it maps them.
pub(super) struct Coordinates {
    pub(super) set: u32,
    map: Option<DAffine2>,
}

impl Coordinates {
    /// Those of a texture; the first ones as they are if there is none.
    ///
    /// The map is that of Khronos, "`KHR_texture_transform`", 2018: coordinates are scaled, then turned counter-clockwise as seen
    /// with `v` down, then moved.
    pub(super) fn of(texture: Option<&Info>) -> Coordinates {
        let Some(texture) = texture else { return Coordinates { set: 0, map: None } };
        let extensions = texture.extensions.as_ref();
        let Some(stated) = extensions.and_then(|all| all.texture_transform.as_ref()) else {
            return Coordinates { set: texture.tex_coord, map: None };
        };
        let [offset, scale] = [stated.offset.0, stated.scale.0]
            .map(|numbers| DVec2::from_array(numbers.map(f64::from)));
        let angle = f64::from(stated.rotation.0);
        // libm gives the same result on every machine.
        let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
        let turned = DMat2::from_cols(DVec2::new(cosine, -sine), DVec2::new(sine, cosine));
        let map = DAffine2::from_mat2_translation(turned * DMat2::from_diagonal(scale), offset);
        Coordinates { set: stated.tex_coord.unwrap_or(texture.tex_coord), map: Some(map) }
    }

    /// The coordinates at which the texture is read.
    pub(super) fn mapped(&self, values: Vec<[f32; 2]>) -> Result<Vec<[f32; 2]>, GltfFault> {
        let Some(map) = self.map else { return Ok(values) };
        let mapped = |value: [f32; 2]| {
            let mapped = map.transform_point2(Vec2::from_array(value).as_dvec2()).as_vec2();
            if mapped.is_finite() {
                Ok(mapped.to_array())
            } else {
                Err(GltfFault::TextureTransform)
            }
        };
        values.into_iter().map(mapped).collect()
    }
}

/// How a texture is read, as a sampler says.
fn sampler(stated: &texture::Sampler) -> Result<Sampler, GltfFault> {
    let invalid = |what| GltfFault::Invalid { what };
    let magnified = match &stated.mag_filter {
        Some(Checked::Valid(MagFilter::Nearest)) => Filter::Nearest,
        Some(Checked::Valid(MagFilter::Linear)) | None => Filter::Bilinear,
        Some(Checked::Invalid) => return Err(invalid("the magFilter of its sampler")),
    };
    let (minified, levels) = match &stated.min_filter {
        Some(Checked::Valid(filter)) => match filter {
            MinFilter::Nearest => (Filter::Nearest, Levels::One),
            MinFilter::Linear => (Filter::Bilinear, Levels::One),
            MinFilter::NearestMipmapNearest => (Filter::Nearest, Levels::Nearest),
            MinFilter::LinearMipmapNearest => (Filter::Bilinear, Levels::Nearest),
            MinFilter::NearestMipmapLinear => (Filter::Nearest, Levels::Blended),
            MinFilter::LinearMipmapLinear => (Filter::Bilinear, Levels::Blended),
        },
        Some(Checked::Invalid) => return Err(invalid("the minFilter of its sampler")),
        None => (Filter::Bilinear, Levels::Blended),
    };
    let wrap = |mode: &Checked<WrappingMode>, what| match mode {
        Checked::Valid(WrappingMode::ClampToEdge) => Ok(Wrap::Clamp),
        Checked::Valid(WrappingMode::MirroredRepeat) => Ok(Wrap::Mirror),
        Checked::Valid(WrappingMode::Repeat) => Ok(Wrap::Repeat),
        Checked::Invalid => Err(invalid(what)),
    };
    let wrap = [
        wrap(&stated.wrap_s, "the wrapS of its sampler")?,
        wrap(&stated.wrap_t, "the wrapT of its sampler")?,
    ];
    Ok(Sampler { magnified, minified, levels, wrap, tiles: [1.0; 2] })
}
