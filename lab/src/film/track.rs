//! The record of one order: its picture, its changes with their colours, and its positions.

use super::recorder::{Change, Plan, Position, Recorder, Survey};
use crate::common::raster::Sample;
use crate::common::{Frame, Observer, Options, View};
use crate::orders::{Method, Order};
use crate::picture::picture;
use crate::{rasterize, raytrace};
use image::{Rgb, RgbImage};
use std::collections::HashMap;

/// The record of one order.
#[derive(Clone, Debug)]
pub(super) struct Track {
    /// All steps.
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
    pub(super) id: Option<u32>,
    /// Whether the pixel now is as it ends.
    pub(super) stays: bool,
}

/// The loops of one order over a view, one sample a pixel.
#[derive(Clone, Debug)]
pub(super) struct Loops<'a> {
    pub(super) order: Order,
    pub(super) method: Method,
    pub(super) view: View<'a>,
    /// All steps.
    pub(super) steps: u64,
    /// The steps before each part of the picture.
    pub(super) parts: HashMap<Sample, u64>,
}

impl<'a> Loops<'a> {
    /// Counts the steps. Those of the textbooks need no counting: every pair is tested.
    pub(super) fn new(order: Order, method: Method, view: View<'a>) -> Loops<'a> {
        let [width, height] = view.camera.image().map(u64::from);
        let steps = view.scene.primitive_count() * width * height;
        let mut loops = Loops { order, method, view, steps, parts: HashMap::new() };
        if method == Method::Fast {
            let (survey, _) = loops.watched(Survey::default());
            (loops.steps, loops.parts) = (survey.steps(), survey.parts);
        }
        loops
    }

    /// Runs the loops for a recorder that looks at these moments; gives the rendered frame as well.
    ///
    /// # Panics
    ///
    /// If the events do not add up to the steps: then the film would not show what happened.
    pub(super) fn record(&self, moments: &[u64]) -> (Frame, Track) {
        let plan = Plan { moments: moments.to_vec(), parts: self.parts.clone() };
        let (recorder, mut frame) = self.watched(Recorder::new(self.order, &plan));
        assert_eq!(recorder.steps(), self.steps, "the same loops take the same steps");
        self.shade(&mut frame);
        let picture = picture(&frame);
        let changes = self.painted(&frame, &picture, &recorder.changes);
        debug_assert!((0..).zip(&recorder.moments).all(|(k, (number, _))| k == *number));
        let positions = recorder.moments.into_iter().map(|(_, position)| position).collect();
        (frame, Track { steps: self.steps, picture, changes, positions })
    }

    /// Runs the loops for an observer. The parts of a picture come to it in an order that no thread changes.
    pub(super) fn watched<O: Observer>(&self, mut observer: O) -> (O, Frame) {
        let (view, options) = (&self.view, &Options::default());
        let mut frame = Frame::new(view.camera, options);
        let (to, watch) = (&mut frame, &mut observer);
        match (self.order, self.method) {
            (Order::Object, Method::Textbook) => {
                rasterize::textbook::determine_visibility(view, options, to, watch);
            }
            (Order::Image, Method::Textbook) => {
                raytrace::textbook::determine_visibility(view, options, to, watch);
            }
            (Order::Object, Method::Fast) => {
                let prepared = rasterize::fast::prepare(view.scene);
                rasterize::fast::determine_visibility(&prepared, view, options, to, watch);
            }
            (Order::Image, Method::Fast) => {
                let prepared = raytrace::fast::prepare(view.scene);
                raytrace::fast::determine_visibility(&prepared, view, options, to, watch);
            }
        }
        (observer, frame)
    }

    pub(super) fn shade(&self, frame: &mut Frame) {
        match self.order {
            Order::Object => rasterize::shade(&self.view, frame),
            Order::Image => raytrace::shade(&self.view, frame),
        }
    }

    /// The changes with their colours. What is seen at the end has its colour in the finished picture. What is hidden later
    /// is shaded as if nothing hid it: the first such changes of all pixels together, then the second ones, and so on.
    pub(super) fn painted(
        &self,
        frame: &Frame,
        finished: &RgbImage,
        changes: &[Change],
    ) -> Vec<Painted> {
        let view = &self.view;
        let width = frame.width();
        let mut layers: Vec<Vec<usize>> = Vec::new();
        let mut depth = vec![0_usize; frame.ids().len()];
        let mut painted = Vec::with_capacity(changes.len());
        for (number, &Change { steps, sample: Sample { row, column }, id }) in
            changes.iter().enumerate()
        {
            let stays = frame.id(row, column) == id.map(u64::from);
            let [i, j] =
                [row, column].map(|index| u32::try_from(index).expect("a side of a picture"));
            let color = *finished.get_pixel(j, i);
            painted.push(Painted { steps, row: i, column: j, color, id, stays });
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
                    let distance =
                        judge.distance(&view.primitive(id.into()), &grid.ray(row, column));
                    shaded.set(row, column, id.into(), distance);
                }
            }
            self.shade(&mut shaded);
            let look = picture(&shaded);
            for number in layer {
                let change = &mut painted[number];
                change.color = *look.get_pixel(change.column, change.row);
            }
        }
        painted
    }
}
