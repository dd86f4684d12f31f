//! The materials of an OBJ file (Wavefront, "MTL Material Format", 1995), and their pictures.
//!
//! The format does not say whether its colours are linear. They are written as sRGB, as most programs show them and as our
//! reader takes them. A picture stands in place of the colour, so it is multiplied by that colour.

use super::pictures::Pictures;
use super::pieces::Piece;
use super::srgb::encoded;
use crate::common::Material;
use crate::common::scene::{Levels, Sampler, Wrap};
use std::fmt::Write;

/// The materials that pieces have, each written once.
pub(super) struct Library {
    scene: String,
    known: Vec<(Material, bool)>,
    text: String,
    pictures: Pictures,
    /// Whether a picture is read in a way that the format has no word for.
    has_other_samplers: bool,
}

impl Library {
    /// The library of a scene of this name.
    pub(super) fn new(scene: &str) -> Library {
        let text = String::new();
        let (known, pictures, has_other_samplers) = (Vec::new(), Pictures::default(), false);
        Library { scene: scene.to_owned(), known, text, pictures, has_other_samplers }
    }

    /// The name of a piece's material.
    pub(super) fn name_of(&mut self, piece: &Piece) -> String {
        let key = (piece.material.clone(), piece.has_coordinates());
        let known = self.known.iter().position(|one| *one == key);
        let number = known.unwrap_or_else(|| {
            let number = self.known.len();
            self.write(number, &key);
            self.known.push(key);
            number
        });
        name(number)
    }

    /// What the format has no word for, if a picture is read in such a way.
    pub(super) fn note(&self) -> Option<String> {
        const NOTE: &str = "OBJ says no filter, and repeats or clamps a picture in both directions: others are left out";
        self.has_other_samplers.then(|| NOTE.to_owned())
    }

    /// The file of the materials, under a name, and the pictures beside it.
    pub(super) fn files(self, name: String) -> impl Iterator<Item = (String, Vec<u8>)> {
        let file = (name, self.text.into_bytes());
        std::iter::once(file).chain(self.pictures.named(&self.scene).collect::<Vec<_>>())
    }

    fn write(&mut self, number: usize, (material, has_coordinates): &(Material, bool)) {
        let text = &mut self.text;
        // Writing to a text cannot fail.
        let _ = writeln!(text, "newmtl {}", name(number));
        let [red, green, blue] = material.color.to_array().map(encoded);
        let _ = writeln!(text, "Kd {red} {green} {blue}");
        if material.specular > 0.0 {
            let strength = material.specular;
            let _ =
                writeln!(text, "Ks {strength} {strength} {strength}\nNs {}", material.shininess);
        }
        let Some(texture) = material.texture.as_ref().filter(|_| *has_coordinates) else { return };
        let picture = self.pictures.place(&texture.pyramid, material.color);
        let Sampler { tiles: [across, up], wrap, .. } = texture.sampler;
        let scale =
            if [across, up] == [1.0; 2] { String::new() } else { format!("-s {across} {up} ") };
        let clamp = if wrap == [Wrap::Clamp; 2] { "-clamp on " } else { "" };
        let file = Pictures::name(&self.scene, picture);
        let _ = writeln!(text, "map_Kd {scale}{clamp}{file}");
        let usual = texture.sampler.levels == Levels::Blended
            && [[Wrap::Clamp; 2], [Wrap::Repeat; 2]].contains(&wrap);
        self.has_other_samplers |= !usual;
    }
}

fn name(number: usize) -> String {
    format!("material-{number}")
}
