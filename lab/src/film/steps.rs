//! Every step of one order's loops over a small picture, to step through: what was tested, and what came of it.
//!
//! A film shows some moments of long loops; this keeps all moments of short ones.

use super::code::code;
use super::recorder::{Line, Plan, Recorder, short};
use super::track::{Loops, Painted};
use crate::common::raster::Sample;
use crate::common::{Events, Observer, View};
use crate::orders::{Method, Order};
use crate::wording::grouped;
use std::collections::HashMap;

/// The most steps that are kept.
pub const MOST_KEPT: u64 = 3_000_000;

/// What came of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Outcome {
    /// The object does not affect the pixel.
    #[default]
    NotCovered = 0,
    /// It does, and is the first to do so.
    First = 1,
    /// It does, and is nearer than what was stored, which it replaces.
    Nearer = 2,
    /// It does, and lies behind what is stored.
    Behind = 3,
    /// The ray misses the box.
    Missed = 4,
    /// The ray enters the box.
    Entered = 5,
}

/// A step: a pair of a primitive and a pixel that is tested, or a pixel's ray and a box of the hierarchy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// The primitive, or the box.
    pub tested: Tested,
    /// The row of the pixel.
    pub row: u16,
    /// The column of the pixel.
    pub column: u16,
    /// What came of it.
    pub outcome: Outcome,
    /// Where the ray meets the primitive, if the primitive covers the pixel.
    pub t: Option<f32>,
}

/// What a step tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tested {
    /// A primitive, by its id.
    Primitive(u32),
    /// A box of the hierarchy, by the number of its node.
    Node(u32),
}

/// A change of the stored picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StoredChange {
    /// The number of steps that were done by then.
    pub steps: u32,
    /// The row of the pixel.
    pub row: u16,
    /// The column of the pixel.
    pub column: u16,
    /// The primitive that is stored from now on; `None` once it is known that nothing is seen.
    pub id: Option<u32>,
    /// What it looks like, in sRGB.
    pub color: [u8; 3],
}

/// All steps of one order.
#[derive(Clone, Debug, PartialEq)]
pub struct Steps {
    /// The lecture's pseudocode, a line for each [`Line`].
    pub code: [&'static str; 5],
    /// The steps, in the order in which they are done.
    pub steps: Vec<Step>,
    /// The changes of the stored picture, in the order in which they happen. Object order stores a fragment at once; image order
    /// stores a pixel when its ray is done.
    pub changes: Vec<StoredChange>,
    /// The steps at which object order begins an object, or image order a row of pixels.
    pub marks: Vec<u32>,
}

/// Why the steps are not kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "these loops take {} steps, {} objects and {} pixels, and at most {} are kept to step through; choose a smaller \
     image, a scene with fewer objects, or a method that skips more",
    grouped(*.steps), grouped(*.primitives), grouped(*.pixels), grouped(MOST_KEPT)
)]
pub struct TooManySteps {
    /// The steps.
    pub steps: u64,
    /// The primitives of the scene.
    pub primitives: u64,
    /// The pixels of the picture.
    pub pixels: u64,
}

impl Step {
    /// The line of the code that is lit.
    pub fn line(&self) -> Line {
        match (self.tested, self.outcome) {
            (Tested::Node(_), _) => Line::Inner,
            (_, Outcome::First | Outcome::Nearer | Outcome::Behind) => Line::Keep,
            _ => Line::Test,
        }
    }
}

impl Steps {
    /// Renders a view in one order, and keeps all steps. The textbook tests every pair; the fast method skips pairs, by bounding
    /// boxes in object order and by a hierarchy in image order.
    ///
    /// # Errors
    ///
    /// There are too many.
    ///
    /// ```
    /// use bothways_lab::common::{Camera, CameraDescription, View};
    /// use bothways_lab::film::Steps;
    /// use bothways_lab::orders::{Method, Order};
    ///
    /// let loaded = bothways_lab::scenes::load("canonical")?;
    /// let camera = Camera::new(CameraDescription { image: [8, 8], ..loaded.camera })?;
    /// let view = View::new(&loaded.scene, &camera);
    /// let [object_order, image_order] = Order::ALL.map(|order| Steps::record(order, Method::Textbook, &view));
    /// let (object_order, image_order) = (object_order?, image_order?);
    ///
    /// // The same pairs, in another order.
    /// assert_eq!(object_order.steps.len(), 3 * 8 * 8);
    /// assert_eq!(image_order.steps.len(), 3 * 8 * 8);
    /// assert_eq!((object_order.marks.len(), image_order.marks.len()), (3, 8));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn record(order: Order, method: Method, view: &View) -> Result<Steps, TooManySteps> {
        let primitives = view.scene.primitive_count();
        let image = view.camera.image();
        let pixels = image.map(u64::from).iter().product();
        let has_short_sides = image.iter().all(|&side| side <= u32::from(u16::MAX));
        let check = |steps| match steps {
            0..=MOST_KEPT if has_short_sides => Ok(()),
            _ => Err(TooManySteps { steps, primitives, pixels }),
        };
        // By the fast method the number is known only after a first run, which is worth it for small pictures; not where
        // ids have 64 bits, as there are more primitives than steps that are kept.
        let is_known = method == Method::Textbook || view.scene.has_wide_ids();
        check(primitives.saturating_mul(if is_known { pixels } else { 0 }).max(pixels))?;
        let loops = Loops::new(order, method, *view);
        check(loops.steps)?;
        let (steps, painted) = loops.keep();
        let changes = painted.iter().map(|change| change.stored()).collect();
        let mut steps =
            Steps { code: code(order, method), marks: marks(order, &steps), steps, changes };
        steps.find_distances(method, view);
        Ok(steps)
    }

    /// The exact judge says where the rays meet what covers their pixels. The fast ray tracer drops what is certainly farther
    /// than the nearest so far, and does not ask whether it covers the sample: the judge says that, too.
    fn find_distances(&mut self, method: Method, view: &View) {
        let (judge, grid) = (view.judge(), view.camera.sample_grid(1));
        for step in &mut self.steps {
            let Tested::Primitive(id) = step.tested else { continue };
            if method == Method::Textbook && step.outcome == Outcome::NotCovered {
                continue;
            }
            let (ray, primitive) =
                (grid.ray(step.row.into(), step.column.into()), view.primitive(id.into()));
            if step.outcome == Outcome::NotCovered && judge.covers(&primitive, &ray) {
                step.outcome = Outcome::Behind;
            }
            if step.line() == Line::Keep {
                #[expect(clippy::cast_possible_truncation, reason = "a frame stores t as f32, too")]
                let t = judge.distance(&primitive, &ray) as f32;
                step.t = Some(t);
            }
        }
    }
}

/// Where the outer loop takes its next value: an object, or a pixel of another row.
fn marks(order: Order, steps: &[Step]) -> Vec<u32> {
    let outer = |step: &Step| match (order, step.tested) {
        (Order::Object, Tested::Primitive(id)) => id,
        _ => step.row.into(),
    };
    let mut last = None;
    let begins = (0..).zip(steps).filter_map(|(number, step)| {
        let now = Some(outer(step));
        (std::mem::replace(&mut last, now) != now).then_some(number)
    });
    begins.collect()
}

impl Painted {
    fn stored(&self) -> StoredChange {
        let small = |index: u32| u16::try_from(index).expect("a picture with short sides");
        StoredChange {
            steps: u32::try_from(self.steps).expect("few steps"),
            row: small(self.row),
            column: small(self.column),
            id: self.id,
            color: self.color.0,
        }
    }
}

impl Loops<'_> {
    /// Runs the loops for a keeper of all steps; gives the changes as well.
    fn keep(&self) -> (Vec<Step>, Vec<Painted>) {
        let plan = Plan { moments: Vec::new(), parts: self.parts.clone() };
        let keeper = Keeper { told_late: self.method == Method::Fast, ..Keeper::default() };
        let observer = (keeper, Recorder::new(self.order, &plan));
        let ((keeper, recorder), mut frame) = self.watched(observer);
        self.shade(&mut frame);
        let picture = crate::picture::picture(&frame);
        let painted = self.painted(&frame, &picture, &recorder.changes);
        (keeper.steps, painted)
    }
}

/// An observer that keeps all steps.
#[derive(Debug, Default)]
struct Keeper {
    steps: Vec<Step>,
    /// Whether what came of a test may be told after further tests: the fast renderers test some pairs at once, and tell the
    /// results together.
    told_late: bool,
    /// The steps that tested each pair, if so.
    pairs: HashMap<(Sample, u32), usize>,
}

impl Keeper {
    fn begin(&mut self, sample: Sample, tested: Tested, outcome: Outcome) {
        let small = |index| u16::try_from(index).expect("a picture with short sides");
        let (row, column) = (small(sample.row), small(sample.column));
        self.steps.push(Step { tested, row, column, outcome, t: None });
    }

    /// Notes what came of the test of a pair.
    fn note(&mut self, sample: Sample, primitive: u32, outcome: Outcome) {
        let step = match self.told_late {
            true => self.pairs.get(&(sample, primitive)).map(|&step| &mut self.steps[step]),
            false => self.steps.last_mut(),
        };
        if let Some(step) = step {
            step.outcome = outcome;
        }
    }
}

impl Observer for Keeper {
    fn fork(&self) -> Self {
        Keeper { told_late: self.told_late, ..Keeper::default() }
    }

    fn join(&mut self, part: Self) {
        self.steps.extend(part.steps);
    }
}

impl Events for Keeper {
    fn node_opened(&mut self, sample: Sample, node: u32, entered: bool) {
        let outcome = if entered { Outcome::Entered } else { Outcome::Missed };
        self.begin(sample, Tested::Node(node), outcome);
    }

    fn sample_tested(&mut self, sample: Sample, primitive: u64) {
        if self.told_late {
            self.pairs.insert((sample, short(primitive)), self.steps.len());
        }
        self.begin(sample, Tested::Primitive(short(primitive)), Outcome::NotCovered);
    }

    fn fragment(&mut self, sample: Sample, primitive: u64) {
        self.note(sample, short(primitive), Outcome::First);
    }

    fn depth_test(&mut self, sample: Sample, incoming: u64, _stored: u64, replaced: bool) {
        let outcome = if replaced { Outcome::Nearer } else { Outcome::Behind };
        self.note(sample, short(incoming), outcome);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::{Camera, CameraDescription, Frame, Options};
    use crate::{rasterize, scenes};

    fn both(name: &str, method: Method, check: impl Fn(Order, &Steps, &View, &Frame)) {
        let loaded = scenes::load(name).unwrap();
        let camera = CameraDescription { image: [24, 16], ..loaded.camera };
        let camera = Camera::new(camera).unwrap();
        let view = View::new(&loaded.scene, &camera);
        let frame = rasterize::textbook::render(&view, &Options::default());
        for order in Order::ALL {
            check(order, &Steps::record(order, method, &view).unwrap(), &view, &frame);
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
                    let at = usize::from(change.row) * frame.width() + usize::from(change.column);
                    stored[at] = change.id;
                    assert!(change.steps as usize <= steps.steps.len());
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
                for step in &steps.steps {
                    let Tested::Primitive(id) = step.tested else { continue };
                    let ray = grid.ray(step.row.into(), step.column.into());
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
            let is_pair = |step: &&Step| matches!(step.tested, Tested::Primitive(_));
            let pairs = steps.steps.iter().filter(is_pair).count();
            let all = view.scene.name_count() as usize * 24 * 16;
            assert!(pairs > 0 && pairs < all / 2, "{order:?}: {pairs} of {all}");
        });
    }

    #[test]
    fn too_many_steps_are_refused_before_they_are_done() {
        let loaded = scenes::load("many").unwrap();
        let camera = Camera::new(loaded.camera).unwrap();
        let view = View::new(&loaded.scene, &camera);
        let error = Steps::record(Order::Object, Method::Textbook, &view).unwrap_err();
        assert!(error.to_string().ends_with("or a method that skips more"), "{error}");
    }
}
