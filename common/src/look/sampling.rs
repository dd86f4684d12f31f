//! Reads textures: at a place, and for a sample of some size.
//!
//! Everything here is computed for one sample at a time, with numbers that are rounded alike on every machine.

use crate::scene::texture::{Filter, Level, Levels, Texture, Wrap};
use glam::{DVec2, Vec2, Vec3};

/// By how much of a texel a place lies to the right of where it is, and below it, when it decides between two texels.
///
/// Where textures and cameras are aligned, many places lie exactly on the border between two texels. Each order rounds its
/// coordinates in its own way, and so would choose its own texel. The shift is far more than these roundings, and moves
/// borders to where no such places are.
const OFF_BORDERS: f64 = 1.0 / (1 << 20) as f64;

impl Texture {
    /// The colour at a texture coordinate: linear red, green and blue.
    ///
    /// `level` says how large a sample is there: see [`Texture::level`]. It does not matter to a texture without
    /// [footprint](crate::scene::Sampler::has_footprint).
    ///
    /// A coordinate that is not finite reads some texel.
    pub fn color(&self, coordinate: DVec2, level: f32) -> Vec3 {
        let sampler = &self.sampler;
        let [across, up] = sampler.tiles.map(f64::from);
        // Rows are counted from the top.
        let at = [coordinate.x * across, 1.0 - coordinate.y * up];
        let (picture, wrap) = (&self.pyramid.levels()[0], sampler.wrap);
        let is_minified = level > 0.0;
        if !is_minified {
            return sampler.magnified.color(picture, wrap, at);
        }
        let filter = sampler.minified;
        let last = self.pyramid.levels().len() - 1;
        match sampler.levels {
            Levels::One => filter.color(picture, wrap, at),
            Levels::Nearest => {
                filter.color(&self.pyramid.levels()[whole((level + 0.5).floor(), last)], wrap, at)
            }
            Levels::Blended => {
                let (below, part) = (whole(level.floor(), last), level - level.floor());
                let color = filter.color(&self.pyramid.levels()[below], wrap, at);
                if below == last || part == 0.0 {
                    return color;
                }
                mixed(color, filter.color(&self.pyramid.levels()[below + 1], wrap, at), part)
            }
        }
    }

    /// The level whose texels are as large as a sample is on the texture, from how far the texture coordinate moves to the
    /// next sample across and down: the logarithm to base 2 of the longer of the two ways, in texels of the picture. 0 is
    /// the picture itself, and a negative level a part of a texel; 64 stands for all that is larger, or no number.
    ///
    /// "The OpenGL Graphics System: A Specification", version 4.6, 2022, equation 8.7.
    pub fn level(&self, [across, down]: [Vec2; 2]) -> f32 {
        let size = self.pyramid.levels()[0].size();
        level_of(size, self.sampler.tiles, [across, down])
    }
}

/// [`Texture::level`] of a picture of this width and height, so often in one unit of the texture coordinate.
pub fn level_of(size: [usize; 2], tiles: [f32; 2], steps: [Vec2; 2]) -> f32 {
    #[expect(clippy::cast_precision_loss, reason = "a level needs no more digits")]
    let texels = Vec2::new(size[0] as f32 * tiles[0], size[1] as f32 * tiles[1]);
    let [across, down] = steps.map(|step| (step * texels).length_squared());
    if !(across + down).is_finite() {
        return LARGEST;
    }
    (0.5 * libm::log2f(across.max(down))).clamp(-LARGEST, LARGEST)
}

/// A level above that of any picture.
const LARGEST: f32 = 64.0;

impl Filter {
    /// The colour at a place: parts of the picture's width from the left, and of its height from the top.
    fn color(self, level: &Level, wrap: [Wrap; 2], at: [f64; 2]) -> Vec3 {
        let size = level.size();
        let place = |k: usize| wrap[k].place(at[k], size[k]);
        match self {
            Filter::Nearest => {
                let index = |k: usize| wrap[k].index(floor(place(k) + OFF_BORDERS), size[k]);
                level.texel(index(1), index(0))
            }
            Filter::Bilinear => {
                // The middles of the texels count.
                let [left, above] = [0, 1].map(|k| place(k) - 0.5);
                #[expect(
                    clippy::cast_possible_truncation,
                    reason = "a weight needs no more digits"
                )]
                let [right_part, below_part] =
                    [left, above].map(|place| (place - place.floor()) as f32);
                let indices = |k: usize, first: isize| {
                    [first, first + 1].map(|index| wrap[k].index(index, size[k]))
                };
                let (columns, rows) = (indices(0, floor(left)), indices(1, floor(above)));
                let [upper, lower] = rows.map(|row| {
                    let [one, other] = columns.map(|column| level.texel(row, column));
                    mixed(one, other, right_part)
                });
                mixed(upper, lower, below_part)
            }
        }
    }
}

impl Wrap {
    /// Where a place lies, in texels: within the picture or the two halves of a pattern of pictures, or next to it.
    fn place(self, at: f64, size: usize) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "sides have fewer than 53 bits")]
        let size = size as f64;
        match self {
            Wrap::Repeat => (at - at.floor()) * size,
            Wrap::Mirror => (at - 2.0 * (0.5 * at).floor()) * size,
            Wrap::Clamp => at.clamp(-1.0, 2.0) * size,
        }
    }

    /// The texel that stands at an index, which may be next to the picture.
    fn index(self, index: isize, size: usize) -> usize {
        let count = size.cast_signed();
        let within = match self {
            Wrap::Repeat => index.rem_euclid(count),
            Wrap::Clamp => index.clamp(0, count - 1),
            Wrap::Mirror => {
                let in_both = index.rem_euclid(2 * count);
                if in_both < count { in_both } else { 2 * count - 1 - in_both }
            }
        };
        within.cast_unsigned()
    }
}

fn mixed(one: Vec3, other: Vec3, part: f32) -> Vec3 {
    one + (other - one) * part
}

/// The integer below a place; 0 for what is no number.
fn floor(place: f64) -> isize {
    #[expect(clippy::cast_possible_truncation, reason = "a place next to a picture")]
    let whole = place.floor() as isize;
    whole
}

/// A level that is a positive whole number, and at most the last one.
fn whole(level: f32, last: usize) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 64")]
    let level = level as usize;
    level.min(last)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::texture::{Pyramid, Sampler};
    use glam::DVec3;

    const WRAPS: [Wrap; 3] = [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror];

    /// A picture without symmetry.
    fn texels(count: usize) -> Vec<Vec3> {
        let value = |k: usize| (k as f32 * 0.618_034).fract();
        (0..count).map(|k| Vec3::new(value(k), value(3 * k + 1), value(7 * k))).collect()
    }

    fn texture(height: usize, width: usize, sampler: Sampler) -> Texture {
        Texture { pyramid: Pyramid::new(width, texels(width * height)).into(), sampler }
    }

    /// The texel in a column and a row of an endless wall of pictures, found by walking there.
    fn on_wall(level: &Level, wrap: [Wrap; 2], mut place: [i64; 2]) -> DVec3 {
        for k in [0, 1] {
            let size = i64::try_from(level.size()[k]).unwrap();
            let mut is_mirrored = false;
            while !(0..size).contains(&place[k]) {
                match wrap[k] {
                    Wrap::Clamp => place[k] = if place[k] < 0 { 0 } else { size - 1 },
                    _ => place[k] += if place[k] < 0 { size } else { -size },
                }
                is_mirrored ^= wrap[k] == Wrap::Mirror;
            }
            if is_mirrored {
                place[k] = size - 1 - place[k];
            }
        }
        let [column, row] = place.map(|index| usize::try_from(index).unwrap());
        level.texels()[row * level.size()[0] + column].as_dvec3()
    }

    /// The wall of texels, each a square of one colour, or weighted by tents of twice their size.
    fn slowly(level: &Level, wrap: [Wrap; 2], filter: Filter, coordinate: DVec2) -> DVec3 {
        let [width, height] = level.size().map(|side| side as f64);
        let place = DVec2::new(coordinate.x * width, (1.0 - coordinate.y) * height);
        let weight = |from_middle: f64| match filter {
            Filter::Nearest => f64::from(u8::from((-0.5..0.5).contains(&from_middle))),
            Filter::Bilinear => (1.0 - from_middle.abs()).max(0.0),
        };
        let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
        let [i, j] = [place.x, place.y].map(|at| i64::try_from(floor(at)).unwrap());
        for row in j - 2..j + 3 {
            for column in i - 2..i + 3 {
                // The place relative to the middle of the texel.
                let [x, y] = [(place.x, column), (place.y, row)].map(|(at, k)| at - k as f64 - 0.5);
                let part = weight(-x) * weight(-y);
                sum += part * on_wall(level, wrap, [column, row]);
                weights += part;
            }
        }
        assert!((weights - 1.0).abs() < 1e-9, "{coordinate}");
        sum
    }

    #[test]
    fn every_filter_and_wrap_reads_what_the_slow_way_reads() {
        let mut reads = 0;
        for (height, width) in [(4, 4), (3, 5), (1, 1), (6, 1), (2, 7)] {
            for (across, up) in WRAPS.into_iter().flat_map(|a| WRAPS.map(|b| (a, b))) {
                for filter in [Filter::Nearest, Filter::Bilinear] {
                    let wrap = [across, up];
                    let sampler =
                        Sampler { magnified: filter, minified: filter, wrap, ..Sampler::NEAREST };
                    let texture = texture(height, width, sampler);
                    for k in 1..401_u32 {
                        // From −2 to 4, never on a border of texels.
                        let at = |turn: f64| (f64::from(k) * turn).fract() * 6.0 - 2.0;
                        let coordinate = DVec2::new(at(0.618_034), at(0.754_878));
                        let found = texture.color(coordinate, 0.0).as_dvec3();
                        let expected =
                            slowly(&texture.pyramid.levels()[0], wrap, filter, coordinate);
                        let apart = (found - expected).abs().max_element();
                        assert!(apart < 1e-6, "{wrap:?} {filter:?} {coordinate}: {apart}");
                        reads += 1;
                    }
                }
            }
        }
        assert_eq!(reads, 5 * 9 * 2 * 400);
    }

    #[test]
    fn the_picture_stands_upright() {
        // Its rows are A B and C D: so C is at the lower left.
        let [a, b, c, d] = [1.0, 2.0, 3.0, 4.0].map(|value| Vec3::splat(value / 4.0));
        let pyramid = Pyramid::new(2, vec![a, b, c, d]).into();
        let texture = Texture { pyramid, sampler: Sampler::NEAREST };
        let at = |x, y| texture.color(DVec2::new(x, y), 0.0);
        assert_eq!([at(0.25, 0.75), at(0.75, 0.75)], [a, b]);
        assert_eq!([at(0.25, 0.25), at(0.75, 0.25)], [c, d]);
        assert_eq!(at(-0.75, -0.75), c, "the lower left again");
    }

    #[test]
    fn tiles_count_pictures_in_a_unit() {
        let sampler = Sampler { tiles: [3.0, 0.5], ..Sampler::NEAREST };
        let (tiled, plain) = (texture(4, 4, sampler), texture(4, 4, Sampler::NEAREST));
        for (x, y) in [(0.1, 0.3), (0.7, 1.9), (-0.4, 0.2)] {
            let expected = plain.color(DVec2::new(3.0 * x, 0.5 * y), 0.0);
            assert_eq!(tiled.color(DVec2::new(x, y), 0.0), expected);
        }
        let steps = [Vec2::new(1.0 / 12.0, 0.0), Vec2::ZERO];
        assert!(tiled.level(steps).abs() < 1e-6, "one texel");
    }

    /// Both neighbours of a border see the same texel, if they are as close to it as roundings are.
    #[test]
    fn what_is_on_a_border_but_for_roundings_is_on_one_side() {
        let texture = texture(8, 8, Sampler::NEAREST);
        for k in -20..20 {
            let border = f64::from(k) / 8.0;
            let read = [-1e-12, 0.0, 1e-12].map(|off| {
                [DVec2::new(border + off, 0.3), DVec2::new(0.3, border + off)]
                    .map(|at| texture.color(at, 0.0))
            });
            assert!(read.iter().all(|one| *one == read[0]), "{border}");
        }
    }

    #[test]
    fn the_level_is_how_often_a_sample_doubles_a_texel() {
        let texture = texture(32, 64, Sampler::MIPMAPS);
        let texel = Vec2::new(1.0 / 64.0, 1.0 / 32.0);
        for (factor, level) in [(1.0, 0.0), (2.0, 1.0), (16.0, 4.0), (0.25, -2.0), (3.0, 1.585)] {
            let [across, up] = [Vec2::new(texel.x * factor, 0.0), Vec2::new(0.0, texel.y * factor)];
            for steps in [[across, up], [up, across], [across, Vec2::ZERO], [Vec2::ZERO, up]] {
                assert!((texture.level(steps) - level).abs() < 1e-3, "{factor} {steps:?}");
            }
        }
        assert_eq!(texture.level([Vec2::ZERO; 2]), -64.0);
        for odd in [f32::NAN, f32::INFINITY, f32::MAX] {
            assert_eq!(texture.level([Vec2::new(odd, 0.0), Vec2::ZERO]), 64.0);
        }
    }

    #[test]
    fn between_levels_their_colors_are_mixed() {
        let texture = texture(16, 16, Sampler::MIPMAPS);
        let at = DVec2::new(0.37, 0.81);
        let of_level = |k: usize| {
            slowly(&texture.pyramid.levels()[k], [Wrap::Repeat; 2], Filter::Bilinear, at)
        };
        for (level, expected) in [
            (-3.0, of_level(0)),
            (1.0, of_level(1)),
            (1.25, of_level(1) * 0.75 + of_level(2) * 0.25),
            (3.5, of_level(3) * 0.5 + of_level(4) * 0.5),
            (4.0, of_level(4)),
            (64.0, of_level(4)),
        ] {
            let found = texture.color(at, level).as_dvec3();
            assert!((found - expected).abs().max_element() < 1e-6, "{level}: {found} {expected}");
        }
        let nearest = Sampler { levels: Levels::Nearest, ..Sampler::MIPMAPS };
        let nearest = Texture { sampler: nearest, ..texture.clone() };
        for (level, is) in [(0.4, 0), (0.6, 1), (3.4, 3), (9.0, 4)] {
            let found = nearest.color(at, level).as_dvec3();
            assert!((found - of_level(is)).abs().max_element() < 1e-6, "{level}");
        }
    }

    #[test]
    fn odd_coordinates_read_some_texel() {
        for wrap in WRAPS {
            for sampler in [Sampler::NEAREST, Sampler::BILINEAR, Sampler::MIPMAPS] {
                let texture = texture(3, 5, Sampler { wrap: [wrap; 2], ..sampler });
                for odd in [f64::NAN, f64::INFINITY, -f64::INFINITY, 1e300, -1e300, -1e-300] {
                    for level in [0.0, 1.5, 64.0, f32::NAN] {
                        let color = texture.color(DVec2::new(odd, 0.5), level);
                        assert!(color.y >= 0.0 || odd.is_nan() || odd.is_infinite(), "{color}");
                    }
                }
            }
        }
    }
}
