//! The `instances` of a mesh: where each is, or a rule that says it. The documentation of [`scene_file`](super) lists the
//! forms.

use super::document::{Item, Table};
use super::error::Problem;
use super::transform::{self, Transform, sine_and_cosine};
use bothways_common::scene::{Instances, InstancesError, Mesh, Placement};
use glam::{DAffine3, DMat3, DVec3, Vec3};
use std::ops::Range;

pub(super) const KEY: &str = "instances";
const EXAMPLE: &str = "instances = [[0, 0, 0], [2, 0, 0]]";
const RULES: [&str; 2] = ["grid", "scatter"];

/// The most instances of an object: 800 MB of placements.
const MOST: u64 = 1 << 24;

/// The instances that an object's table states; `None` if it states none.
pub(super) fn read(object: &Table) -> Result<Option<Vec<Placement>>, Problem> {
    let Some(item) = object.get(KEY) else { return Ok(None) };
    let placements = if item.is_table() {
        let table = item.table(&RULES)?;
        let rule = table.exactly_one(
            KEY,
            &RULES,
            "instances = { grid = { count = [10, 1, 10], spacing = 2 } }",
        )?;
        if rule.name == "grid" { grid(&rule)? } else { scatter(&rule)? }
    } else {
        item.list(EXAMPLE)?.iter().map(placement).collect::<Result<_, _>>()?
    };
    Ok(Some(placements))
}

/// The mesh in these places.
pub(super) fn placed(
    mesh: Mesh,
    placements: Vec<Placement>,
    span: Range<usize>,
) -> Result<Instances, Problem> {
    Instances::new(mesh, placements).map_err(|error| {
        let (InstancesError::NotFinite { instance } | InstancesError::OutOfRange { instance }) =
            error;
        let message =
            format!("instance {instance}, counted from 0, reaches where no f32 number does");
        Problem::new(span, message).help("stay between -3.4e38 and 3.4e38")
    })
}

/// One instance: where it is moved, a table of scale, rotate and translate, or the twelve numbers of a map.
fn placement(item: &Item) -> Result<Placement, Problem> {
    if item.is_table() {
        let table = item.table(&transform::KEYS)?;
        let placed = Transform::read(&table)?.map(|transform| transform.placement());
        return Ok(placed.unwrap_or(Placement::IDENTITY));
    }
    let what = "3 numbers that move it, 12 (the rows of a 3 x 4 matrix), or a table of scale, rotate and translate";
    let numbers = item.numbers(what)?;
    if let [x, y, z] = numbers[..] {
        return Ok(Placement::translation(Vec3::new(x, y, z)));
    }
    match numbers.as_chunks::<4>() {
        ([x, y, z], []) => Ok(Placement::from_rows([*x, *y, *z])),
        _ => Err(item.problem(format!("has {} numbers; it must be {what}", numbers.len()))),
    }
}

/// Instances on a grid about the origin, along x first, then along y, then along z.
fn grid(item: &Item) -> Result<Vec<Placement>, Problem> {
    const EXAMPLE: &str = "grid = { count = [10, 1, 10], spacing = 2 }";
    let table = item.table(&["count", "spacing"])?;
    let counts = table.need("count", EXAMPLE)?;
    let [nx, ny, nz] = counts.three_counts()?;
    let count = [nx, ny, nz].into_iter().map(u64::from).try_fold(1, u64::checked_mul);
    check_count(&counts, count)?;
    let spacing = table.need("spacing", EXAMPLE)?;
    let spacing =
        if spacing.is_number() { Vec3::splat(spacing.number()?) } else { spacing.vector()? };
    let along = |index: u32, count: u32, spacing: f32| {
        (f64::from(index) - 0.5 * (f64::from(count) - 1.0)) * f64::from(spacing)
    };
    let place = |x: u32, y: u32, z: u32| {
        let [x, y, z] = [along(x, nx, spacing.x), along(y, ny, spacing.y), along(z, nz, spacing.z)];
        Placement::translation(DVec3::new(x, y, z).as_vec3())
    };
    // A list that grew would have room for up to twice as many.
    let count = count.and_then(|count| usize::try_from(count).ok()).unwrap_or(0);
    let mut placements = Vec::with_capacity(count);
    // Where there are none along one axis, there may be very many along others.
    let nz = if count == 0 { 0 } else { nz };
    for z in 0..nz {
        for y in 0..ny {
            placements.extend((0..nx).map(|x| place(x, y, z)));
        }
    }
    Ok(placements)
}

/// Instances anywhere in a box about the origin, turned about an axis and scaled; the same for the same seed.
fn scatter(item: &Item) -> Result<Vec<Placement>, Problem> {
    const EXAMPLE: &str = "scatter = { count = 1000, size = [40, 0, 40], seed = 1 }";
    let table = item.table(&["count", "size", "seed", "turn", "scale"])?;
    let counts = table.need("count", EXAMPLE)?;
    let count = counts.count()?;
    check_count(&counts, Some(count.into()))?;
    let size = table.need("size", EXAMPLE)?.vector()?.as_dvec3();
    let seed = table.get("seed").map_or(Ok(0), |item| item.count())?;
    let axis = table.get("turn").map(|item| item.direction()).transpose()?;
    let [least, most] = table.get("scale").map_or(Ok([1.0; 2]), |item| item.positive_pair())?;
    let (least, most) = (f64::from(least), f64::from(most));
    let mut dice = Dice(u64::from(seed));
    let place = |_| {
        let by = DVec3::new(dice.part() - 0.5, dice.part() - 0.5, dice.part() - 0.5) * size;
        let (scale, turn) = (least + dice.part() * (most - least), dice.part());
        let matrix3 = axis.map_or(DMat3::IDENTITY, |axis| turned(axis, turn)) * scale;
        Placement::from_affine(&DAffine3 { matrix3, translation: by })
    };
    Ok((0..count).map(place).collect())
}

/// A turn about an axis by a part of a whole turn, the same on every machine.
fn turned(axis: Vec3, part: f64) -> DMat3 {
    #[expect(clippy::cast_possible_truncation, reason = "any angle will do")]
    let [sine, cosine] = sine_and_cosine((360.0 * part) as f32);
    let axis = axis.as_dvec3() / axis.as_dvec3().length();
    let column = |vector: DVec3| {
        vector * cosine + axis.cross(vector) * sine + axis * axis.dot(vector) * (1.0 - cosine)
    };
    DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z))
}

fn check_count(item: &Item, count: Option<u64>) -> Result<(), Problem> {
    match count {
        Some(0..=MOST) => Ok(()),
        _ => Err(item
            .problem(format!("asks for more than {MOST} instances"))
            .help("divide them between several objects")),
    }
}

/// Numbers that look random: the generator `SplitMix64` of Steele, Lea and Flood, "Fast Splittable Pseudorandom Number
/// Generators", OOPSLA 2014.
struct Dice(u64);

impl Dice {
    /// A number from 0 up to, but not, 1.
    fn part(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ (bits >> 31)) >> 11) as f64 * (-53f64).exp2()
    }
}
