//! Every step of one order's loops over a small picture, to step through: what was tested, and what came of it.
//!
//! A film shows some moments of long loops; this keeps all moments of short ones.

use super::code::code;
use super::keeper::{Keeper, Listener, MOST_KEPT};
use super::recorder::Plan;
use super::step::{Outcome, Run, Step, Tested, Told};
use super::track::{Loops, Painted};
use crate::common::View;
use crate::orders::{Method, Order};
use crate::picture::picture;
use crate::wording::grouped;

/// The most steps of a textbook that are kept. They need little room, but time: a minute or so. All built-in scenes have fewer at
/// 64 × 64.
pub const MOST_TEXTBOOK_STEPS: u64 = 1 << 29;

/// The most steps of a fast method that are kept: tens of megabytes.
pub const MOST_FAST_STEPS: u64 = 3_000_000;

/// A change of the stored picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StoredChange {
    /// The number of steps that were done by then.
    pub steps: u32,
    /// The row of the pixel.
    pub row: u32,
    /// The column of the pixel.
    pub column: u32,
    /// The primitive that is stored from now on; `None` once it is known that nothing is seen.
    pub id: Option<u32>,
    /// What it looks like, in sRGB.
    pub color: [u8; 3],
}

/// All steps of one order. [`Steps::step`] gives any of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Steps {
    /// The lecture's pseudocode, a line for each [`Line`](super::Line).
    pub code: [&'static str; 5],
    /// The number of all steps.
    pub count: u32,
    /// The runs of the inner loop, in the order in which they are done. They say what every step tests.
    pub runs: Vec<Run>,
    /// What came of the steps that found something, ascending; all others found that the object does not affect the pixel.
    pub told: Vec<Told>,
    /// The changes of the stored picture, in the order in which they happen. Object order stores a fragment at once; image order
    /// stores a pixel when its ray is done.
    pub changes: Vec<StoredChange>,
    /// The steps at which object order begins an object, or image order a row of pixels.
    pub marks: Vec<u32>,
    order: Order,
    width: u32,
}

/// Why the steps are not kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TooManySteps {
    /// It would take too long, or too much room.
    #[error(
        "these loops take {} steps, {} objects and {} pixels, and at most {} are kept to step through; choose a smaller \
         image, a scene with fewer objects, or a method that skips more",
        grouped(*.steps), grouped(*.primitives), grouped(*.pixels), grouped(*.most)
    )]
    Steps {
        /// The steps.
        steps: u64,
        /// The most that are kept.
        most: u64,
        /// The primitives of the scene.
        primitives: u64,
        /// The pixels of the picture.
        pixels: u64,
    },
    /// Too many objects lie one behind another.
    #[error(
        "of these loops' {} steps, more than {} find that an object affects a pixel, which is more than are kept to step \
         through; choose a smaller image, or a scene with fewer objects behind one another",
        grouped(*.steps), grouped(MOST_KEPT as u64)
    )]
    Found {
        /// The steps.
        steps: u64,
    },
}

impl Steps {
    /// Renders a view in one order, and keeps all steps. The textbook tests every pair; the fast method skips pairs, by bounding
    /// boxes in object order and by a hierarchy in image order. Calls `listener` now and then with the number of steps that are
    /// done, and of all steps.
    ///
    /// # Errors
    ///
    /// There are too many.
    ///
    /// ```
    /// use bothways_lab::common::{Camera, CameraDescription, View};
    /// use bothways_lab::film::{Outcome, Steps, Tested};
    /// use bothways_lab::orders::{Method, Order};
    ///
    /// let loaded = bothways_lab::scenes::load("canonical")?;
    /// let camera = Camera::new(CameraDescription { image: [8, 8], ..loaded.camera })?;
    /// let view = View::new(&loaded.scene, &camera);
    /// let record = |order| Steps::record(order, Method::Textbook, &view, &|_done, _of| ());
    /// let (object_order, image_order) = (record(Order::Object)?, record(Order::Image)?);
    ///
    /// // The same pairs, in another order.
    /// assert_eq!((object_order.count, image_order.count), (3 * 8 * 8, 3 * 8 * 8));
    /// assert_eq!((object_order.marks.len(), image_order.marks.len()), (3, 8));
    /// let [one, same] = [object_order.step(64 + 8 * 2 + 5), image_order.step(3 * (8 * 2 + 5) + 1)];
    /// assert_eq!((one.tested, one.row, one.column), (Tested::Primitive(1), 2, 5));
    /// assert_eq!((same.tested, same.row, same.column), (Tested::Primitive(1), 2, 5));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn record(
        order: Order,
        method: Method,
        view: &View,
        listener: &(dyn Fn(u32, u32) + Sync),
    ) -> Result<Steps, TooManySteps> {
        let primitives = view.scene.primitive_count();
        let [width, height] = view.camera.image();
        let pixels = u64::from(width) * u64::from(height);
        let most = match method {
            Method::Textbook => MOST_TEXTBOOK_STEPS,
            Method::Fast => MOST_FAST_STEPS,
        };
        let check = |steps| match u32::try_from(steps) {
            Ok(count) if steps <= most => Ok(count),
            _ => Err(TooManySteps::Steps { steps, most, primitives, pixels }),
        };
        // By the fast method the number is known only after a first run, which is worth it for small pictures.
        // Where ids have 64 bits, there are more primitives than steps that are kept.
        let is_known = method == Method::Textbook || view.scene.has_wide_ids();
        let at_least = if is_known { primitives } else { 1 };
        check(pixels.saturating_mul(at_least))?;
        let loops = Loops::new(order, method, *view);
        let count = check(loops.steps)?;
        let mut steps = Steps::keep(&loops, width, &|done| listener(done, count))
            .ok_or(TooManySteps::Found { steps: loops.steps })?;
        assert_eq!(steps.count, count, "the same loops take the same steps");
        steps.find_distances(method, view);
        Ok(steps)
    }

    /// Runs the loops for a keeper; `None` if it has no room for what it is told.
    fn keep(loops: &Loops, width: u32, listener: Listener) -> Option<Steps> {
        let plan = Plan { moments: Vec::new(), parts: loops.parts.clone() };
        let (order, method) = (loops.order, loops.method);
        let (mut keeper, mut frame) =
            loops.watched(Keeper::new(order, method, width, &plan, listener));
        if !keeper.has_room() {
            return None;
        }
        keeper.sort();
        loops.shade(&mut frame);
        let painted = loops.painted(&frame, &picture(&frame), &keeper.recorder.changes);
        let changes = painted.iter().map(Painted::stored).collect();
        let Keeper { count, runs, told, .. } = keeper;
        let (code, marks) = (code(order, method), marks(order, width, &runs));
        Some(Steps { code, count, runs, told, changes, marks, order, width })
    }

    /// A step, by its number from 0.
    ///
    /// # Panics
    ///
    /// If there are not that many.
    pub fn step(&self, number: u32) -> Step {
        assert!(number < self.count, "step {number} of {}", self.count);
        let run = self.runs[self.runs.partition_point(|run| run.first <= number) - 1];
        let along = number - run.first;
        let (tested, pixel) = match (self.order, run.tested) {
            (Order::Image, Tested::Primitive(id)) => (Tested::Primitive(id + along), run.pixel),
            (_, tested) => (tested, run.pixel + along),
        };
        let told = self.told.binary_search_by_key(&number, |told| told.step).ok();
        let (outcome, t) =
            told.map_or((Outcome::NotCovered, None), |at| (self.told[at].outcome, self.told[at].t));
        Step { tested, row: pixel / self.width, column: pixel % self.width, outcome, t }
    }

    /// The exact judge says where the rays meet what covers their pixels. The fast ray tracer drops what is certainly farther
    /// than the nearest so far, and does not ask whether it covers the sample: the judge says that, too.
    fn find_distances(&mut self, method: Method, view: &View) {
        let (judge, grid) = (view.judge(), view.camera.sample_grid(1));
        let look = |number| {
            let Step { tested, row, column, mut outcome, .. } = self.step(number);
            let told = |outcome, t| Told { step: number, outcome, t };
            let Tested::Primitive(id) = tested else { return Some(told(outcome, None)) };
            let ray = grid.ray(row as usize, column as usize);
            let primitive = view.primitive(id.into());
            if outcome == Outcome::NotCovered {
                if method == Method::Textbook || !judge.covers(&primitive, &ray) {
                    return None;
                }
                outcome = Outcome::Behind;
            }
            #[expect(clippy::cast_possible_truncation, reason = "a frame stores t as f32, too")]
            let t = judge.distance(&primitive, &ray) as f32;
            Some(told(outcome, Some(t)))
        };
        self.told = match method {
            Method::Textbook => self.told.iter().filter_map(|told| look(told.step)).collect(),
            Method::Fast => (0..self.count).filter_map(look).collect(),
        };
    }
}

/// Where the outer loop takes its next value: an object, or a pixel of another row. Nothing else happens within a run.
fn marks(order: Order, width: u32, runs: &[Run]) -> Vec<u32> {
    let outer = |run: &Run| match (order, run.tested) {
        (Order::Object, Tested::Primitive(id)) => id,
        _ => run.pixel / width,
    };
    let begins = |(at, run): (usize, &Run)| {
        let goes_on = at > 0 && outer(&runs[at - 1]) == outer(run);
        (!goes_on).then_some(run.first)
    };
    runs.iter().enumerate().filter_map(begins).collect()
}

impl Painted {
    fn stored(&self) -> StoredChange {
        StoredChange {
            steps: u32::try_from(self.steps).expect("few steps"),
            row: self.row,
            column: self.column,
            id: self.id,
            color: self.color.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::{Camera, CameraDescription, Frame, Options};
    use crate::film::Line;
    use crate::formats::source::{GivenFile, InputFile};
    use crate::{rasterize, scenes};
    use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

    fn record(order: Order, method: Method, view: &View) -> Result<Steps, TooManySteps> {
        Steps::record(order, method, view, &|_, _| ())
    }

    fn both(name: &str, method: Method, check: impl Fn(Order, &Steps, &View, &Frame)) {
        let loaded = scenes::load(name).unwrap();
        let camera = CameraDescription { image: [24, 16], ..loaded.camera };
        let camera = Camera::new(camera).unwrap();
        let view = View::new(&loaded.scene, &camera);
        let frame = rasterize::textbook::render(&view, &Options::default());
        for order in Order::ALL {
            check(order, &record(order, method, &view).unwrap(), &view, &frame);
        }
    }

    /// The page shows the picture that the changes make: it must end as the rendered one.
    #[test]
    fn the_changes_end_in_the_rendered_picture() {
        for (name, method) in [
            ("canonical", Method::Textbook),
            ("ties", Method::Textbook),
            ("canonical", Method::Fast),
            ("overlap", Method::Fast),
        ] {
            both(name, method, |order, steps, _, frame| {
                let mut stored = vec![None; frame.ids().len()];
                for change in &steps.changes {
                    let at = change.row as usize * frame.width() + change.column as usize;
                    stored[at] = change.id;
                    assert!(change.steps <= steps.count);
                }
                for (at, id) in stored.into_iter().enumerate() {
                    let [row, column] = [at / frame.width(), at % frame.width()];
                    assert_eq!(
                        id.map(u64::from),
                        frame.id(row, column),
                        "{name} {order:?} ({row}, {column})"
                    );
                }
                assert!(steps.changes.is_sorted_by_key(|change| change.steps));
            });
        }
    }

    #[test]
    fn every_pair_has_its_outcome() {
        for method in [Method::Textbook, Method::Fast] {
            both("overlap", method, |order, steps, view, _| {
                let (judge, grid) = (view.judge(), view.camera.sample_grid(1));
                for step in (0..steps.count).map(|number| steps.step(number)) {
                    let Tested::Primitive(id) = step.tested else { continue };
                    let ray = grid.ray(step.row as usize, step.column as usize);
                    let covers = judge.covers(&view.primitive(id.into()), &ray);
                    assert_eq!(covers, step.line() == Line::Keep, "{order:?} {step:?}");
                    assert_eq!(covers, step.t.is_some());
                }
            });
        }
    }

    #[test]
    fn the_fast_method_skips_pairs() {
        both("ties", Method::Fast, |order, steps, view, _| {
            let is_pair = |&number: &u32| matches!(steps.step(number).tested, Tested::Primitive(_));
            let pairs = (0..steps.count).filter(is_pair).count();
            let all = view.scene.name_count() as usize * 24 * 16;
            assert!(pairs > 0 && pairs < all / 2, "{order:?}: {pairs} of {all}");
        });
    }

    /// The textbooks test every pair in the order of their loops, and each pair once.
    #[test]
    fn runs_are_the_two_loops() {
        both("overlap", Method::Textbook, |order, steps, view, _| {
            let (objects, pixels) = (view.scene.name_count(), 24 * 16);
            assert_eq!(steps.count, objects * pixels);
            assert_eq!(
                steps.runs.len(),
                (if order == Order::Object { objects } else { pixels }) as usize
            );
            for number in 0..steps.count {
                let (object, pixel) = match order {
                    Order::Object => (number / pixels, number % pixels),
                    Order::Image => (number % objects, number / objects),
                };
                let Step { tested, row, column, .. } = steps.step(number);
                assert_eq!(
                    (tested, row, column),
                    (Tested::Primitive(object), pixel / 24, pixel % 24)
                );
            }
        });
    }

    /// Millions of steps in hundreds of kilobytes.
    #[test]
    fn the_teapot_needs_little_room() {
        let loaded = scenes::load("lecture").unwrap();
        let camera = Camera::new(CameraDescription { image: [24, 24], ..loaded.camera }).unwrap();
        let view = View::new(&loaded.scene, &camera);
        for order in Order::ALL {
            let (heard, last) = (AtomicU32::new(0), AtomicU32::new(0));
            let listener = |done, of| {
                heard.fetch_add(1, Relaxed);
                assert!(last.swap(done, Relaxed) < done && done <= of);
            };
            let steps = Steps::record(order, Method::Textbook, &view, &listener).unwrap();
            assert!(steps.count as usize > MOST_KEPT, "{}", steps.count);
            let bytes = size_of_val(&steps.runs[..]) + size_of_val(&steps.told[..]);
            assert!(bytes < 300_000, "{order:?}: {bytes}");
            assert!(heard.into_inner() > 10, "someone who waits hears about it");
        }
    }

    #[test]
    fn too_many_steps_are_refused_before_they_are_done() {
        let loaded = scenes::load("many").unwrap();
        let camera = Camera::new(loaded.camera).unwrap();
        let view = View::new(&loaded.scene, &camera);
        let error = record(Order::Object, Method::Textbook, &view).unwrap_err();
        assert!(error.to_string().ends_with("or a method that skips more"), "{error}");
    }

    /// Each of many objects before the one before, each over the whole picture: there is something to keep of every step.
    #[test]
    fn too_many_fragments_are_refused() {
        let plane = |number| {
            format!("[[object]]\nplane = {{ point = [0, 0, {number}], normal = [0, 0, 1] }}\n")
        };
        let objects: String = (0..800).map(plane).collect();
        let text = format!("[camera]\neye = [0, 0, 1000]\nimage = [64, 64]\n{objects}");
        let files = [GivenFile::new("planes.toml", text.as_bytes())];
        let loaded = scenes::load_file(&InputFile::given(&files, 0), None).unwrap();
        let camera = Camera::new(loaded.camera).unwrap();
        let view = View::new(&loaded.scene, &camera);
        let error = record(Order::Object, Method::Textbook, &view).unwrap_err();
        let says = "of these loops' 3,276,800 steps, more than 3,000,000 find that an object affects a pixel";
        assert!(error.to_string().starts_with(says), "{error}");
    }
}
