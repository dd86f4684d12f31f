//! How each order finds quickly what matters: the boxes of the ray tracer's hierarchy by level, the rasterizer's
//! clusters and tiles, over the picture.

use crate::common::glam::Vec3;
use crate::figure::drawing::{Anchor, Drawing, Ink, Pen};
use crate::figure::project::{Projector, corners_of_box};
use crate::figure::sheet::{MARGIN, Sheet, TOP};
use crate::figure::subject::{FigureError, Subject, small_picture};
use crate::figure::theme::{Role, faded};
use crate::wording::{count, grouped};
use crate::{rasterize, raytrace};
use image::RgbImage;
use raytrace::fast::HierarchyBox;

const PANEL: [f64; 2] = [560.0, 330.0];
const TOPS: [f64; 2] = [TOP + 44.0, TOP + 440.0];
const STEP: f64 = 608.0;
/// The most boxes of which a panel shows all edges, and the most that it shows at all.
const WHOLE: usize = 160;
const MOST: usize = 1200;

pub(super) fn draw(subject: &Subject) -> Result<Drawing, FigureError> {
    let view = &subject.view;
    let theme = subject.theme;
    let boxes = raytrace::fast::prepare(view.scene).boxes();
    let prepared = rasterize::fast::prepare(view.scene);
    let clusters = prepared.cluster_boxes(view.scene);
    if boxes.is_empty() {
        return Err(FigureError::new(
            "the scene has planes alone, and nothing bounds a plane; draw another scene",
        ));
    }
    let point = "Image order asks a box before what is in it; object order asks a cluster before its triangles.";
    let mut sheet = Sheet::new(subject, "Boxes, so that most is never looked at", point);
    let picture = faded(&small_picture(view, 1120), theme, 0.4);
    let image = Role::Image;
    for (column, (name, level)) in levels(&boxes).into_iter().enumerate() {
        let of_level: Vec<[Vec3; 2]> =
            boxes.iter().filter(|one| level.holds(one)).map(|one| [one.low, one.high]).collect();
        let corner = [MARGIN + column as f64 * STEP, TOPS[0]];
        panel(
            &mut sheet,
            subject,
            &picture,
            corner,
            (&format!("image order: {name}"), "boxes", image),
            &of_level,
        );
    }
    let of_clusters: Vec<[Vec3; 2]> = clusters.iter().map(|one| [one.low, one.high]).collect();
    let corner = [MARGIN, TOPS[1]];
    let name = "object order: clusters";
    panel(&mut sheet, subject, &picture, corner, (name, "clusters", Role::Object), &of_clusters);
    tiles(&mut sheet, subject, &picture, prepared.tile(), [MARGIN + STEP, TOPS[1]]);
    numbers(&mut sheet, subject, &boxes, clusters.len(), [MARGIN + 2.0 * STEP, TOPS[1]]);
    Ok(sheet.drawing)
}

/// Which boxes a panel shows.
#[derive(Clone, Copy, Debug)]
enum Level {
    At(usize),
    Leaves,
}

impl Level {
    fn holds(self, one: &HierarchyBox) -> bool {
        match self {
            Level::At(level) => one.level == level,
            Level::Leaves => one.primitives.is_some(),
        }
    }
}

/// The first level, one in the middle, and the leaves: as far as they are different.
fn levels(boxes: &[HierarchyBox]) -> Vec<(String, Level)> {
    let deepest = boxes.iter().map(|one| one.level).max().unwrap_or(0);
    let name = |level: usize| format!("level {}", level + 1);
    let mut levels = Vec::new();
    if deepest >= 1 {
        levels.push((name(0), Level::At(0)));
    }
    if deepest >= 2 {
        levels.push((name(deepest / 2), Level::At(deepest / 2)));
    }
    levels.push(("leaves".into(), Level::Leaves));
    levels
}

fn panel(
    sheet: &mut Sheet,
    subject: &Subject,
    picture: &RgbImage,
    corner: [f64; 2],
    (name, things, role): (&str, &str, Role),
    boxes: &[[Vec3; 2]],
) {
    let theme = sheet.theme;
    let size = sheet.picture(picture.clone(), corner, PANEL);
    let every = boxes.len().div_ceil(MOST).max(1);
    let note = match every {
        1 => count(boxes.len() as u64, things),
        every => format!("{}, 1 in {every} drawn", grouped(boxes.len() as u64)),
    };
    sheet.heading(corner, size[0].max(400.0), name, &note);
    let projector = Projector { camera: subject.view.camera };
    let [width, height] = subject.view.camera.image().map(f64::from);
    let place = |[column, row]: [f64; 2]| {
        [corner[0] + column / width * size[0], corner[1] + row / height * size[1]]
    };
    sheet.drawing.window(Some((corner, size)));
    let few = boxes.len() <= WHOLE;
    let pen =
        Pen::new(theme.of(role), if few { 1.8 } else { 1.0 }).alpha(if few { 0.95 } else { 0.7 });
    for bounds in boxes.iter().step_by(every) {
        let corners = corners_of_box(&subject.view, *bounds);
        let seen: Option<Vec<[f64; 2]>> =
            corners.iter().map(|corner| projector.place(*corner)).collect();
        // A box that reaches behind the eye has no rectangle around it: its edges are drawn.
        let seen = seen.filter(|_| !few);
        let Some(seen) = seen else {
            for edge in projector.edges_of_box(&corners) {
                let edge: Vec<[f64; 2]> = edge.into_iter().map(place).collect();
                sheet.drawing.line(&edge, pen);
            }
            continue;
        };
        // Of many boxes, the rectangle around each on the raster.
        let end = |axis: usize, pick: fn(f64, f64) -> f64| {
            seen.iter().map(|at| at[axis]).reduce(pick).unwrap_or(0.0)
        };
        let (low, high) =
            ([end(0, f64::min), end(1, f64::min)], [end(0, f64::max), end(1, f64::max)]);
        let around = [low, [high[0], low[1]], high, [low[0], high[1]]].map(place);
        sheet.drawing.closed_line(&around, pen);
    }
    sheet.drawing.window(None);
}

/// The tiles of the rasterizer: each thread draws one at a time.
fn tiles(
    sheet: &mut Sheet,
    subject: &Subject,
    picture: &RgbImage,
    tile: [usize; 2],
    corner: [f64; 2],
) {
    let theme = sheet.theme;
    let [width, height] = subject.view.camera.image().map(|side| side as usize);
    let number = height.div_ceil(tile[0]) * width.div_ceil(tile[1]);
    let size = sheet.picture(picture.clone(), corner, PANEL);
    let tiles = count(number as u64, "tiles");
    sheet.heading(corner, size[0].max(400.0), "object order: tiles", &tiles);
    let pen = Pen::new(theme.of(Role::Object), 2.5);
    for row in (tile[0]..height).step_by(tile[0]) {
        let y = corner[1] + row as f64 / height as f64 * size[1];
        sheet.drawing.line(&[[corner[0], y], [corner[0] + size[0], y]], pen);
    }
    for column in (tile[1]..width).step_by(tile[1]) {
        let x = corner[0] + column as f64 / width as f64 * size[0];
        sheet.drawing.line(&[[x, corner[1]], [x, corner[1] + size[1]]], pen);
    }
    sheet.drawing.frame(corner, size, pen);
}

fn numbers(
    sheet: &mut Sheet,
    subject: &Subject,
    boxes: &[HierarchyBox],
    clusters: usize,
    [x, y]: [f64; 2],
) {
    let theme = sheet.theme;
    sheet.heading([x, y], PANEL[0], "in numbers", "");
    let deepest = boxes.iter().map(|one| one.level).max().unwrap_or(0);
    let leaves = boxes.iter().filter(|one| one.primitives.is_some()).count();
    let mut rows: Vec<(String, String)> = Vec::new();
    for level in 0..=deepest {
        let here = boxes.iter().filter(|one| one.level == level).count();
        rows.push((format!("boxes of level {}", level + 1), grouped(here as u64)));
    }
    if rows.len() > 5 {
        let more = rows.len() - 5;
        rows.truncate(5);
        rows.push((format!("and {}", count(more as u64, "more levels")), String::new()));
    }
    rows.push(("leaves".into(), grouped(leaves as u64)));
    rows.push(("clusters of triangles".into(), grouped(clusters as u64)));
    rows.push(("primitives".into(), grouped(subject.view.scene.primitive_count())));
    let step = 40.0;
    for (row, (name, figure)) in rows.iter().enumerate() {
        let baseline = y + 30.0 + row as f64 * step;
        let style = theme.text();
        sheet.drawing.text([x, baseline], Anchor::Left, name, style.of(theme.quiet()));
        sheet.drawing.text([x + PANEL[0], baseline], Anchor::Right, figure, style.tabular());
        sheet.drawing.rectangle([x, baseline + 11.0], [PANEL[0], 1.0], Ink::new(theme.hairline()));
    }
}
