//! The record of one order: its picture, its changes with their colours, and its positions.

use super::recorder::{Change, Plan, Position, Recorder, Survey};
use crate::common::raster::Sample;
use crate::common::{Frame, Observer, Options, View, Work};
use crate::orders::{Method, Order, Rendered};
use crate::picture::picture;
use crate::{rasterize, raytrace};
use image::{Rgb, RgbImage};

/// The record of one order.
#[derive(Clone, Debug)]
pub(super) struct Track {
    pub(super) order: Order,
    /// The steps of all.
    pub(super) steps: u64,
    /// The finished picture, as it is rendered.
    pub(super) picture: RgbImage,
    /// Every change of the stored picture, in the order of the clock.
    pub(super) changes: Vec<Painted>,
    /// Where the loops are at the moments of the plan, as long as they run.
    pub(super) positions: Vec<Position>,
}

/// A change with what it looks like.
#[derive(Clone, Copy, Debug)]
pub(super) struct Painted {
    pub(super) steps: u64,
    pub(super) row: u32,
    pub(super) column: u32,
    pub(super) color: Rgb<u8>,
    /// Whether the pixel now is as it ends.
    pub(super) stays: bool,
}

/// One step is a pair of a primitive and a sample, or a box of the hierarchy.
pub(super) fn steps(work: &Work) -> u64 {
    work.tests + work.nodes
}

impl Track {
    /// Renders again what was rendered, and records it.
    ///
    /// # Panics
    ///
    /// If the events do not add up to the picture and to the work: then the film would not show what happened.
    pub(super) fn record(view: &View, rendered: &Rendered, work: &Work, moments: &[u64]) -> Track {
        let Rendered { order, method, frame, .. } = rendered;
        let parts = match method {
            // The textbooks are one part.
            Method::Textbook => Default::default(),
            Method::Fast => watched(view, *order, *method, Survey::default()).parts,
        };
        let plan = Plan { moments: moments.to_vec(), parts };
        let recorder = watched(view, *order, *method, Recorder::new(*order, &plan));
        assert_eq!(recorder.steps(), steps(work), "the record has the steps of the report");
        let finished = picture(frame);
        let changes = painted(view, *order, frame, &finished, &recorder.changes);
        let in_time = |(k, (number, position)): (usize, (usize, Position))| {
            debug_assert_eq!(k, number, "a position for each moment");
            position
        };
        let positions = recorder.moments.into_iter().enumerate().map(in_time).collect();
        Track { order: *order, steps: steps(work), picture: finished, changes, positions }
    }
}

/// Renders for an observer, on this thread alone: it watches the loops in their order.
fn watched<O: Observer>(view: &View, order: Order, method: Method, mut observer: O) -> O {
    let options = Options::default();
    let mut frame = Frame::new(view.camera, &options);
    let (frame, to) = (&mut frame, &mut observer);
    match (order, method) {
        (Order::Object, Method::Textbook) => {
            rasterize::textbook::determine_visibility(view, &options, frame, to);
        }
        (Order::Image, Method::Textbook) => {
            raytrace::textbook::determine_visibility(view, &options, frame, to);
        }
        (Order::Object, Method::Fast) => {
            let prepared = rasterize::fast::prepare(view.scene);
            rasterize::fast::determine_visibility(&prepared, view, &options, frame, to);
        }
        (Order::Image, Method::Fast) => {
            let prepared = raytrace::fast::prepare(view.scene);
            raytrace::fast::determine_visibility(&prepared, view, &options, frame, to);
        }
    }
    observer
}

/// The changes with their colours. What is seen at the end has its colour in the finished picture. What is hidden later
/// is shaded as if nothing hid it: the first such changes of all pixels together, then the second ones, and so on.
fn painted(
    view: &View,
    order: Order,
    frame: &Frame,
    finished: &RgbImage,
    changes: &[Change],
) -> Vec<Painted> {
    let width = frame.width();
    let mut layers: Vec<Vec<usize>> = Vec::new();
    let mut depth = vec![0_usize; frame.ids().len()];
    let mut painted = Vec::with_capacity(changes.len());
    for (number, &Change { steps, sample: Sample { row, column }, id }) in changes.iter().enumerate()
    {
        let stays = frame.id(row, column) == id;
        let [i, j] = [row, column].map(|index| u32::try_from(index).expect("a side of a picture"));
        let color = *finished.get_pixel(j, i);
        painted.push(Painted { steps, row: i, column: j, color, stays });
        if !stays {
            let layer = &mut depth[row * width + column];
            if layers.len() == *layer {
                layers.push(Vec::new());
            }
            layers[*layer].push(number);
            *layer += 1;
        }
    }
    let mut shaded = Frame::new(view.camera, &Options::default());
    let (grid, judge) = (view.camera.sample_grid(1), view.judge());
    for layer in layers {
        shaded.clear();
        for &number in &layer {
            let Change { sample: Sample { row, column }, id, .. } = changes[number];
            if let Some(id) = id {
                let distance = judge.distance(&view.primitive(id), &grid.ray(row, column));
                shaded.set(row, column, id, distance);
            }
        }
        match order {
            Order::Object => rasterize::shade(view, &mut shaded),
            Order::Image => raytrace::shade(view, &mut shaded),
        }
        let look = picture(&shaded);
        for number in layer {
            let change = &mut painted[number];
            change.color = *look.get_pixel(change.column, change.row);
        }
    }
    painted
}
