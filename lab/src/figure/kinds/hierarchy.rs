//! How each order finds quickly what matters: the first boxes of the ray tracer's hierarchy and those that one ray tests, the
//! rasterizer's clusters and tiles.

use super::one_ray::{Path, telling};
use crate::common::{Frame, View};
use crate::figure::drawing::{Anchor, Drawing, Ink, Pen};
use crate::figure::marks::crosshair;
use crate::figure::project::{Projector, corners_of_box};
use crate::figure::sheet::{MARGIN, Sheet, TOP};
use crate::figure::subject::{FigureError, Subject, small_frame};
use crate::figure::theme::{Role, Theme, faded, mixed};
use crate::picture::{color_of_id, picture};
use crate::wording::{count, grouped};
use crate::{rasterize, raytrace};
use image::{Rgb, RgbImage};
use raytrace::fast::HierarchyBox;
use std::collections::HashMap;

const PANEL: [f64; 2] = [560.0, 330.0];
const TOPS: [f64; 2] = [TOP + 44.0, TOP + 440.0];
const STEP: f64 = 608.0;
/// The most boxes of which a panel shows all edges.
const WHOLE: usize = 160;

pub(super) fn draw(subject: &Subject) -> Result<Drawing, FigureError> {
    let view = &subject.view;
    let theme = subject.theme;
    let hierarchy = raytrace::fast::prepare(view.scene);
    let boxes = hierarchy.boxes();
    let prepared = rasterize::fast::prepare(view.scene);
    let clusters = prepared.cluster_boxes(view.scene).len();
    if boxes.is_empty() {
        return Err(FigureError::new(
            "the scene has planes alone, and nothing bounds a plane; draw another scene",
        ));
    }
    let pixel = subject.pixel().map_or_else(|| telling(view), Ok)?;
    let path = Path::of(view, &hierarchy, pixel);
    let point = "Image order asks a box before what is in it; object order asks a cluster before its triangles.";
    let mut sheet = Sheet::new(subject, "Boxes, so that most is never looked at", point);
    let frame = small_frame(view, 1120);
    let bright = picture(&frame);
    let dim = faded(&bright, theme, 0.4);
    let deepest = boxes.iter().map(|one| one.level).max().unwrap_or(0);
    let levels = 0..=deepest.min(1);
    for level in levels.clone() {
        let here: Vec<&HierarchyBox> = boxes.iter().filter(|one| one.level == level).collect();
        let heading =
            (format!("image order: level {}", level + 1), count(here.len() as u64, "boxes"));
        let panel = Panel::new(&mut sheet, subject, &dim, at(level, 0), &heading);
        panel.boxes(&mut sheet, &here);
    }
    one_ray(&mut sheet, subject, (&dim, at(levels.count(), 0)), (&boxes, &path, pixel));
    let of_pixels = mosaic(&prepared, view, &frame, &bright, theme);
    let heading = ("object order: clusters".to_owned(), count(clusters as u64, "clusters"));
    Panel::new(&mut sheet, subject, &of_pixels, at(0, 1), &heading);
    tiles(&mut sheet, subject, &dim, prepared.tile(), at(1, 1));
    numbers(&mut sheet, subject, (&boxes, &path), clusters, at(2, 1));
    Ok(sheet.drawing)
}

/// The corner of a panel.
fn at(column: usize, row: usize) -> [f64; 2] {
    [MARGIN + column as f64 * STEP, TOPS[row]]
}

/// A panel with the picture: where a place on the raster lies on the canvas.
struct Panel<'a> {
    view: View<'a>,
    corner: [f64; 2],
    size: [f64; 2],
}

impl<'a> Panel<'a> {
    fn new(
        sheet: &mut Sheet,
        subject: &Subject<'a>,
        picture: &RgbImage,
        corner: [f64; 2],
        (name, note): &(String, String),
    ) -> Panel<'a> {
        let size = sheet.picture(picture.clone(), corner, PANEL);
        sheet.heading(corner, size[0].max(400.0), name, note);
        Panel { view: subject.view, corner, size }
    }

    fn place(&self, [column, row]: [f64; 2]) -> [f64; 2] {
        let [width, height] = self.view.camera.image().map(f64::from);
        let [x, y] = self.corner;
        [x + column / width * self.size[0], y + row / height * self.size[1]]
    }

    /// Draws the edges of boxes; of many, the rectangle around each on the raster.
    fn boxes(&self, sheet: &mut Sheet, boxes: &[&HierarchyBox]) {
        let few = boxes.len() <= WHOLE;
        let color = sheet.theme.of(Role::Image);
        let pen =
            if few { Pen::new(color, 1.8).alpha(0.95) } else { Pen::new(color, 1.0).alpha(0.7) };
        for one in boxes {
            self.one_box(sheet, one, pen, few);
        }
    }

    fn one_box(&self, sheet: &mut Sheet, one: &HierarchyBox, pen: Pen, edges: bool) {
        sheet.drawing.window(Some((self.corner, self.size)));
        let projector = Projector { camera: self.view.camera };
        let corners = corners_of_box(&self.view, [one.low, one.high]);
        let seen: Option<Vec<[f64; 2]>> =
            corners.iter().map(|corner| projector.place(*corner)).collect();
        // A box that reaches behind the eye has no rectangle around it: its edges are drawn.
        if let Some(seen) = seen.filter(|_| !edges) {
            let end = |axis: usize, pick: fn(f64, f64) -> f64| {
                seen.iter().map(|at| at[axis]).reduce(pick).unwrap_or(0.0)
            };
            let (low, high) =
                ([end(0, f64::min), end(1, f64::min)], [end(0, f64::max), end(1, f64::max)]);
            let around = [low, [high[0], low[1]], high, [low[0], high[1]]];
            sheet.drawing.closed_line(&around.map(|at| self.place(at)), pen);
        } else {
            for edge in projector.edges_of_box(&corners) {
                let edge: Vec<[f64; 2]> = edge.into_iter().map(|at| self.place(at)).collect();
                sheet.drawing.line(&edge, pen);
            }
        }
        sheet.drawing.window(None);
    }
}

/// The boxes that the ray of one pixel tests: those that it hits, and, faint, those that it misses.
fn one_ray(
    sheet: &mut Sheet,
    subject: &Subject,
    (dim, corner): (&RgbImage, [f64; 2]),
    (boxes, path, [i, j]): (&[HierarchyBox], &Path, [u32; 2]),
) {
    let theme = sheet.theme;
    let note =
        format!("{} of {} boxes", grouped(path.opened.len() as u64), grouped(boxes.len() as u64));
    let heading = ("image order: one ray".to_owned(), note);
    let panel = Panel::new(sheet, subject, dim, corner, &heading);
    let by_number: HashMap<u32, &HierarchyBox> =
        boxes.iter().map(|one| (one.number, one)).collect();
    for is_hit in [false, true] {
        let pen = if is_hit {
            Pen::new(theme.of(Role::Image), 2.2)
        } else {
            Pen::new(theme.quiet(), 1.2).alpha(0.8)
        };
        for (number, _) in path.opened.iter().filter(|(_, hit)| *hit == is_hit) {
            if let Some(one) = by_number.get(number) {
                panel.one_box(sheet, one, pen, true);
            }
        }
    }
    sheet.drawing.window(Some((panel.corner, panel.size)));
    crosshair(&mut sheet.drawing, panel.place([f64::from(j) + 0.5, f64::from(i) + 0.5]), theme);
    sheet.drawing.window(None);
}

/// The picture with each pixel in the colour of the cluster that it shows. What is in no cluster is faded.
fn mosaic(
    prepared: &rasterize::fast::Prepared,
    view: &View,
    frame: &Frame,
    picture: &RgbImage,
    theme: Theme,
) -> RgbImage {
    let mut ids: Vec<u64> = frame.ids().iter().flatten().collect();
    ids.sort_unstable();
    ids.dedup();
    let clusters = prepared.clusters_of(view.scene, &ids);
    let cluster_of: HashMap<u64, usize> =
        ids.into_iter().zip(clusters).filter_map(|(id, cluster)| Some((id, cluster?))).collect();
    RgbImage::from_fn(picture.width(), picture.height(), |x, y| {
        let shown = frame.id(y as usize, x as usize).and_then(|id| cluster_of.get(&id));
        Rgb(match shown {
            Some(cluster) => mixed(theme.mat(), color_of_id(Some(*cluster as u64)), 0.85),
            None => mixed(theme.mat(), picture.get_pixel(x, y).0, 0.4),
        })
    })
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
    (boxes, path): (&[HierarchyBox], &Path),
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
    if rows.len() > 4 {
        let more = rows.len() - 3;
        rows.truncate(3);
        rows.push((format!("and {}", count(more as u64, "more levels")), String::new()));
    }
    let hit = path.opened.iter().filter(|(_, is_hit)| *is_hit).count();
    rows.push(("leaves".into(), grouped(leaves as u64)));
    rows.push(("boxes that the ray tests".into(), grouped(path.opened.len() as u64)));
    rows.push(("of these hit: blue".into(), grouped(hit as u64)));
    rows.push(("clusters of triangles: a colour each".into(), grouped(clusters as u64)));
    rows.push(("primitives".into(), grouped(subject.view.scene.primitive_count())));
    let step = 38.0;
    for (row, (name, figure)) in rows.iter().enumerate() {
        let baseline = y + 30.0 + row as f64 * step;
        let style = theme.text();
        sheet.drawing.text([x, baseline], Anchor::Left, name, style.of(theme.quiet()));
        sheet.drawing.text([x + PANEL[0], baseline], Anchor::Right, figure, style.tabular());
        sheet.drawing.rectangle([x, baseline + 11.0], [PANEL[0], 1.0], Ink::new(theme.hairline()));
    }
}
