//! Which pixels a figure looks at if nobody chooses one.

use super::patch::Patch;
use crate::common::exact::{Coverage, EdgeSigns};
use crate::common::{Frame, Options, Primitive, Sign, View};
use crate::figure::subject::{seen, with_image};
use std::collections::{BTreeMap, HashMap};

/// A pixel on the outline of an object, near the middle of the picture; the middle itself if there is no outline.
pub(super) fn outline(view: &View, frame: &Frame) -> [u32; 2] {
    let (height, width) = (frame.height(), frame.width());
    let far = |row: usize, column: usize| {
        (row as f64 - height as f64 / 2.0).hypot(column as f64 - width as f64 / 2.0)
    };
    let object =
        |row: usize, column: usize| frame.id(row, column).map(|id| view.scene.locate(id).0);
    let places = (1..height).flat_map(|row| (1..width).map(move |column| (row, column)));
    let outline = places.filter(|&(row, column)| {
        let here = object(row, column);
        here != object(row, column - 1) || here != object(row - 1, column)
    });
    let nearest = outline.min_by(|a, b| far(a.0, a.1).total_cmp(&far(b.0, b.1)));
    let (row, column) = nearest.unwrap_or((height / 2, width / 2));
    [row, column].map(|part| u32::try_from(part).expect("within the image"))
}

/// Pixels that show different objects: of each of so many of the largest objects in the picture, the pixel nearest to the middle of
/// what is seen of it. The one nearest to the middle of the picture comes first.
pub(super) fn pixels_of_objects(view: &View, most: usize) -> Vec<[u32; 2]> {
    const ACROSS: u32 = 64;
    let [width, height] = view.camera.image();
    let step = (width.max(height) / ACROSS).max(1);
    let camera = with_image(view.camera, [width, height].map(|side| side.div_ceil(step)));
    let small = View::new(view.scene, &camera);
    let frame = seen(&small, &Options::default());
    let mut objects: BTreeMap<usize, Vec<[usize; 2]>> = BTreeMap::new();
    for (row, column) in samples(&frame) {
        if let Some(id) = frame.id(row, column) {
            objects.entry(view.scene.locate(id).0).or_default().push([row, column]);
        }
    }
    let mut objects: Vec<Vec<[usize; 2]>> = objects.into_values().collect();
    objects.sort_by_key(|samples| std::cmp::Reverse(samples.len()));
    objects.truncate(most);
    let middle = [frame.height() as f64 / 2.0, frame.width() as f64 / 2.0];
    let far =
        |[row, column]: [usize; 2], [y, x]: [f64; 2]| (row as f64 - y).hypot(column as f64 - x);
    let mut chosen: Vec<[usize; 2]> = objects
        .iter()
        .filter_map(|samples| {
            let mean = |axis: usize| {
                samples.iter().map(|sample| sample[axis] as f64).sum::<f64>() / samples.len() as f64
            };
            let center = [mean(0), mean(1)];
            samples.iter().copied().min_by(|a, b| far(*a, center).total_cmp(&far(*b, center)))
        })
        .collect();
    chosen.sort_by(|a, b| far(*a, middle).total_cmp(&far(*b, middle)));
    if chosen.is_empty() {
        chosen.push([frame.height() / 2, frame.width() / 2]);
    }
    let whole = |small: usize, side: u32| {
        u32::try_from(small)
            .expect("within the picture")
            .saturating_mul(step)
            .saturating_add(step / 2)
            .min(side - 1)
    };
    chosen.into_iter().map(|[row, column]| [whole(row, height), whole(column, width)]).collect()
}

/// The rows and columns of all samples.
pub(super) fn samples(frame: &Frame) -> impl Iterator<Item = (usize, usize)> + use<> {
    let (height, width) = (frame.height(), frame.width());
    (0..height).flat_map(move |row| (0..width).map(move |column| (row, column)))
}

/// Whether a sample lies on the triangle's boundary: on an edge, and outside none.
pub(super) fn on_boundary(edges: &EdgeSigns) -> bool {
    edges.facing != Sign::Zero
        && edges.in_front
        && edges.at_sample.contains(&Sign::Zero)
        && !edges.at_sample.contains(&-edges.facing)
}

/// A border between two primitives in the picture.
#[derive(Clone, Copy, Debug)]
struct Border {
    /// Row and column of the pixel on its left or above it, and of the one on the other side.
    pixels: [[usize; 2]; 2],
    /// One of the primitives.
    id: u64,
    /// Whether different objects meet, or an object and nothing.
    outline: bool,
}

/// A pixel where something is decided, and the primitive to look at there: best a tie of a triangle, else the outline of
/// an object; of those a primitive of many pixels, and near the middle. `patch` is what is shown around a pixel.
pub(super) fn best_border(
    view: &View,
    frame: &Frame,
    patch: impl Fn([u32; 2]) -> Patch,
) -> Option<([u32; 2], u64)> {
    const MOST: usize = 4000;
    let whole = |part: usize| u32::try_from(part).expect("within the image");
    let borders = borders(view, frame);
    let mut pixels: HashMap<u64, usize> = HashMap::new();
    frame.ids().iter().flatten().for_each(|id| *pixels.entry(id).or_default() += 1);
    let middle = [frame.height() as f64 / 2.0, frame.width() as f64 / 2.0];
    let far = |[row, column]: [usize; 2]| (row as f64 - middle[0]).hypot(column as f64 - middle[1]);
    let judge = view.judge();
    let grid = view.camera.sample_grid(1);
    let is_triangle = |id: u64| matches!(view.primitive(id), Primitive::Triangle(_));
    let at = |pixel: [usize; 2], border: &Border| {
        judge.coverage(&view.primitive(border.id), &grid.ray(pixel[0], pixel[1]))
    };
    let is_tie = |coverage: &Coverage| coverage.edges.is_some_and(|edges| on_boundary(&edges));
    // A patch with a tie that is covered and one that is not shows both sides of the rule.
    let verdicts = |border: &Border| {
        let [row, column] = border.pixels[0];
        let tie = Some(at([row, column], border)).filter(is_tie);
        let Some(tie) = tie.filter(|_| is_triangle(border.id)) else { return 0 };
        let patch = patch([row, column].map(whole));
        let other = |pixel| {
            Some(at(pixel, border)).filter(is_tie).is_some_and(|other| other.covers != tie.covers)
        };
        if patch.pixels().any(other) { 2 } else { 1 }
    };
    // What lies behind the other goes on behind it: there is no edge of its own to see.
    let ends = |border: &Border| {
        let [here, there] = border.pixels.map(|pixel| at(pixel, border).covers);
        here != there
    };
    // A triangle of two dozen pixels fills the patch; more do not matter.
    let seen = |border: &Border| pixels.get(&border.id).copied().unwrap_or(0).min(24);
    let rank = |border: &Border| {
        let triangle = is_triangle(border.id);
        let ends = ends(border);
        (verdicts(border), triangle && ends, ends && border.outline, seen(border))
    };
    let step = borders.len().div_ceil(MOST).max(1);
    let best = borders
        .iter()
        .step_by(step)
        .max_by(|a, b| rank(a).cmp(&rank(b)).then(far(b.pixels[0]).total_cmp(&far(a.pixels[0]))))?;
    Some((best.pixels[0].map(whole), best.id))
}

fn borders(view: &View, frame: &Frame) -> Vec<Border> {
    let (height, width) = (frame.height(), frame.width());
    let object = |id: Option<u64>| id.map(|id| view.scene.locate(id).0);
    let mut borders = Vec::new();
    for row in 0..height {
        for column in 0..width {
            let here = frame.id(row, column);
            let right = if column + 1 < width { frame.id(row, column + 1) } else { here };
            let below = if row + 1 < height { frame.id(row + 1, column) } else { here };
            for (other, there) in [(right, [row, column + 1]), (below, [row + 1, column])] {
                if other == here {
                    continue;
                }
                let outline = object(here) != object(other);
                let of = |id| Border { pixels: [[row, column], there], id, outline };
                borders.extend(here.into_iter().chain(other).map(of));
            }
        }
    }
    borders
}
