//! A report on one pixel: its viewing rays, the primitives that cover its samples, and the results of both orders.
//!
//! The exact judge of the view determines the truth. The renderers' own loops, observed at this pixel alone,
//! determine the results: the report cannot disagree with the picture.

mod candidates;
mod json;
mod lesson;
mod neighbourhood;

pub use lesson::Lesson;
pub use neighbourhood::{Neighbourhood, Outline, neighbourhood};

use crate::common::exact::{EdgeSigns, EdgeValues};
use crate::common::observe::Question;
use crate::common::raster::{Region, Sample};
use crate::common::{Crop, Events, Frame, Observer, Options, Primitive, Ray, Shape, View, Work};
use crate::sample_map::SampleMap;
use crate::{rasterize, raytrace};
use candidates::candidates;
use rayon::prelude::*;
use std::cmp::Ordering;

/// One sample of a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct SampleReport {
    /// The position on the raster of samples.
    pub sample: Sample,
    /// The position on the viewport: `x` along `u`, `y` along `v`.
    pub place: [f64; 2],
    /// The viewing ray of the sample, relative to the eye.
    pub ray: Ray,
    /// The primitives that cover the sample, near to far: the first primitive is visible.
    pub covering: Vec<Covering>,
    /// The triangles with an edge exactly through the sample that do not cover the sample.
    pub touching: Vec<Touching>,
    /// The result of object order.
    pub object_order: Answer,
    /// The result of image order.
    pub image_order: Answer,
}

/// A primitive that covers a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Covering {
    /// The id of the primitive.
    pub id: u64,
    /// The object of the primitive, counted from 0.
    pub object: usize,
    /// The kind of the primitive, in words: `triangle`, `sphere`, `plane` or `triangle of a mesh`.
    pub kind: &'static str,
    /// The distance of the primitive, in lengths of the ray's direction.
    pub t: f64,
    /// The signs of a triangle's edge functions.
    pub edges: Option<EdgeSigns>,
    /// The values of the edge functions.
    pub values: Option<EdgeValues>,
    /// The reason why the primitive comes behind the primitive before it; `None` for the first.
    pub behind: Option<Behind>,
}

/// A triangle that has a sample on its boundary and does not cover it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touching {
    /// The id of the triangle.
    pub id: u64,
    /// The object of the triangle, counted from 0.
    pub object: usize,
    /// The signs of the triangle's edge functions.
    pub edges: EdgeSigns,
    /// The values of the triangle's edge functions.
    pub values: EdgeValues,
}

/// The reason why one primitive comes behind another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Behind {
    /// The `t` of this primitive is greater.
    Farther,
    /// Both have the same `t`; the other primitive is flat and this one is round.
    Round,
    /// Both have the same `t`; the other primitive is nearer on the nudged ray.
    Nudged,
    /// Both have the same `t`, nudged or not; the other primitive comes first in the scene.
    Later,
}

impl Behind {
    /// The reason in words.
    pub fn words(self) -> &'static str {
        match self {
            Behind::Farther => "farther",
            Behind::Round => "tie: the same t, and flat comes before round",
            Behind::Nudged => "tie: the same t, decided by the nudged ray",
            Behind::Later => "tie: the same t, and the first in the scene is seen",
        }
    }
}

/// The result of one order at a sample, and its work there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// The primitive that the order saw.
    pub id: Option<u64>,
    /// The distance that the order found.
    pub t: Option<f32>,
    /// The work of the order's loops at this sample. Its `primitives` are the primitives with a bounding region that
    /// holds the sample.
    pub work: Work,
}

impl SampleReport {
    /// Whether both orders saw the true primitive.
    pub fn agrees(&self) -> bool {
        let truth = self.covering.first().map(|nearest| nearest.id);
        self.object_order.id == truth && self.image_order.id == truth
    }
}

/// Reports on every sample of pixel `(i, j)`, row by row. Both orders render a crop of this pixel alone, with the
/// fast method: their results and their work at its samples are the same as in the whole picture, which needs more
/// memory. (Only the number of the judge's depth decisions may depend on the neighbouring samples.)
///
/// # Panics
///
/// If the image has no such pixel, or [`check_samples`](crate::common::raster::check_samples) refuses the options.
///
/// ```
/// use bothways_lab::common::{Camera, Options, Scene, Sphere, View, glam::Vec3};
///
/// let ball = Sphere { center: Vec3::new(0.0, 0.0, -4.0), radius: 1.0 };
/// let (scene, camera) = (Scene::new(vec![ball.into()])?, Camera::canonical(5, 5));
/// let report = bothways_lab::pixel::report(&View::new(&scene, &camera), &Options::default(), 2, 2);
/// assert_eq!(report[0].covering[0].t, 3.0);
/// assert_eq!((report[0].object_order.id, report[0].image_order.id), (Some(0), Some(0)));
/// # Ok::<(), bothways_lab::common::SceneError>(())
/// ```
pub fn report(view: &View, options: &Options, i: u32, j: u32) -> Vec<SampleReport> {
    let prepared = (&rasterize::fast::prepare(view.scene), &raytrace::fast::prepare(view.scene));
    report_prepared(prepared, view, options, i, j)
}

/// The same with what both orders prepared of the scene, for several pixels.
///
/// # Panics
///
/// Those of [`report`].
pub fn report_prepared(
    prepared: (&rasterize::fast::Prepared, &raytrace::fast::Prepared),
    view: &View,
    options: &Options,
    i: u32,
    j: u32,
) -> Vec<SampleReport> {
    let [width, height] = view.camera.image();
    assert!(i < height && j < width, "there is no pixel ({i}, {j})");
    let crop = Crop { row: i, column: j, height: 1, width: 1 };
    let options = &Options { crop: Some(crop), ..*options };
    let pixel = crop.region(options.samples);
    let [object_order, image_order] = answers(prepared, view, options, &pixel);
    let grid = view.camera.sample_grid(options.samples);
    let answers = object_order.into_iter().zip(image_order);
    let answered: Vec<_> = samples(&pixel).zip(answers).collect();
    let report = answered.into_par_iter().map(|(sample, (object_order, image_order))| {
        let Sample { row, column } = sample;
        let ray = grid.ray(row, column);
        let (covering, touching) = truth(view, &ray);
        let place = [grid.x()[column], grid.y()[row]];
        SampleReport { sample, place, ray, covering, touching, object_order, image_order }
    });
    report.collect()
}

/// The results of both orders at each sample of the pixel.
fn answers(
    (rasterizer, ray_tracer): (&rasterize::fast::Prepared, &raytrace::fast::Prepared),
    view: &View,
    options: &Options,
    pixel: &Region,
) -> [Vec<Answer>; 2] {
    let object_order = watched(view, options, pixel, |frame, watch| {
        rasterize::fast::determine_visibility(rasterizer, view, options, frame, watch);
    });
    let image_order = watched(view, options, pixel, |frame, watch| {
        raytrace::fast::determine_visibility(ray_tracer, view, options, frame, watch);
    });
    [object_order, image_order]
}

fn samples(pixel: &Region) -> impl Iterator<Item = Sample> + use<> {
    let columns = pixel.columns.clone();
    let rows = pixel.rows.clone();
    rows.flat_map(move |row| columns.clone().map(move |column| Sample { row, column }))
}

/// The primitives that cover a sample, near to far, and the triangles that only touch it.
fn truth(view: &View, ray: &Ray) -> (Vec<Covering>, Vec<Touching>) {
    let judge = view.judge();
    let values = |primitive: &Primitive| match primitive {
        Primitive::Triangle(corners) => Some(judge.edge_values(corners, ray)),
        Primitive::Sphere { .. } | Primitive::Plane { .. } => None,
    };
    let (mut found, mut touching) = (Vec::new(), Vec::new());
    for (id, primitive) in candidates(view, ray) {
        let coverage = judge.coverage(&primitive, ray);
        if coverage.covers {
            found.push((id, primitive, coverage.edges));
        } else if let Some(edges) = coverage.edges.filter(touches)
            && let Some(values) = values(&primitive)
        {
            touching.push(Touching { id, object: view.scene.locate(id).0, edges, values });
        }
    }
    found.sort_by(|(id, one, _), (other_id, other, _)| {
        judge.compare(one, other, ray).decided.then(id.cmp(other_id))
    });
    let covering = (0..found.len()).map(|place| {
        let (id, primitive, edges) = &found[place];
        let nearer = place.checked_sub(1).map(|before| &found[before].1);
        let (object, _) = view.scene.locate(*id);
        Covering {
            id: *id,
            object,
            kind: kind(&view.scene.objects()[object].shape),
            t: judge.distance(primitive, ray),
            edges: *edges,
            values: values(primitive),
            behind: nearer.map(|nearer| behind(view, nearer, primitive, ray)),
        }
    });
    (covering.collect(), touching)
}

/// Whether an uncovered sample lies on the boundary: the sample is not outside any edge.
fn touches(edges: &EdgeSigns) -> bool {
    let outside = -edges.facing;
    edges.facing != outside && edges.in_front && !edges.at_sample.contains(&outside)
}

fn behind(view: &View, nearer: &Primitive, primitive: &Primitive, ray: &Ray) -> Behind {
    let order = view.judge().compare(nearer, primitive, ray);
    match (order.at_sample, order.decided) {
        (Ordering::Equal, Ordering::Equal) => Behind::Later,
        (Ordering::Equal, _) if nearer.is_round() != primitive.is_round() => Behind::Round,
        (Ordering::Equal, _) => Behind::Nudged,
        _ => Behind::Farther,
    }
}

fn kind(shape: &Shape) -> &'static str {
    match shape {
        Shape::Triangle(_) => "triangle",
        Shape::Sphere(_) => "sphere",
        Shape::Plane(_) => "plane",
        Shape::Mesh(_) => "triangle of a mesh",
        Shape::Instances(_) => "triangle of an instance",
    }
}

/// Renders, and returns the result and the work at each sample of the pixel.
fn watched(
    view: &View,
    options: &Options,
    pixel: &Region,
    render: impl FnOnce(&mut Frame, &mut Watch),
) -> Vec<Answer> {
    let mut frame = Frame::new(view.camera, options);
    let mut watch = Watch::new(pixel);
    render(&mut frame, &mut watch);
    let answers = samples(pixel).map(|sample @ Sample { row, column }| Answer {
        id: frame.id(row, column),
        t: frame.t(row, column),
        work: watch.work.get(sample),
    });
    answers.collect()
}

/// An observer that counts the work at the samples of one pixel.
#[derive(Clone, Debug)]
struct Watch {
    pixel: Region,
    work: SampleMap<Work>,
}

impl Watch {
    fn new(pixel: &Region) -> Watch {
        Watch { pixel: pixel.clone(), work: SampleMap::new(Work::default()) }
    }

    fn tell(&mut self, sample: Sample, event: impl FnOnce(&mut Work)) {
        let Region { rows, columns } = &self.pixel;
        if rows.contains(&sample.row) && columns.contains(&sample.column) {
            event(self.work.get_mut(sample));
        }
    }
}

impl Observer for Watch {
    fn fork(&self) -> Self {
        Watch::new(&self.pixel)
    }

    fn join(&mut self, part: Self) {
        self.work.join(part.work, |work, more| work.join(more));
    }
}

impl Events for Watch {
    fn primitive_begun(&mut self, primitive: u64, region: &Region) {
        for sample in samples(&self.pixel.intersection(region)) {
            self.tell(sample, |work| work.primitive_begun(primitive, region));
        }
    }

    fn ray_begun(&mut self, sample: Sample) {
        self.tell(sample, |work| work.ray_begun(sample));
    }

    fn node_opened(&mut self, sample: Sample, node: u32, entered: bool) {
        self.tell(sample, |work| work.node_opened(sample, node, entered));
    }

    fn sample_tested(&mut self, sample: Sample, primitive: u64) {
        self.tell(sample, |work| work.sample_tested(sample, primitive));
    }

    fn fragment(&mut self, sample: Sample, primitive: u64) {
        self.tell(sample, |work| work.fragment(sample, primitive));
    }

    fn depth_test(&mut self, sample: Sample, incoming: u64, stored: u64, replaced: bool) {
        self.tell(sample, |work| work.depth_test(sample, incoming, stored, replaced));
    }

    fn judged(&mut self, sample: Sample, question: Question) {
        self.tell(sample, |work| work.judged(sample, question));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::{Camera, Projection};
    use crate::scenes;

    /// The report of a pixel holds for the whole picture, not for a separate picture of the pixel.
    #[test]
    fn a_pixel_alone_is_answered_as_in_the_whole_picture() {
        for (name, projection) in [
            ("lecture", Projection::Perspective),
            ("slivers", Projection::Parallel),
            ("overlap", Projection::Perspective),
        ] {
            let loaded = scenes::load(name).unwrap();
            let mut description = loaded.camera;
            (description.projection, description.image) = (projection, [80, 60]);
            let camera = Camera::new(description).unwrap();
            let view = View::new(&loaded.scene, &camera);
            let rasterizer = rasterize::fast::prepare(view.scene);
            let ray_tracer = raytrace::fast::prepare(view.scene);
            let prepared = (&rasterizer, &ray_tracer);
            let whole = Options { samples: 2, ..Options::default() };
            for [row, column] in [[0, 0], [31, 32], [32, 40], [59, 79]] {
                let crop = Crop { row, column, height: 1, width: 1 };
                let alone = Options { crop: Some(crop), ..whole };
                let pixel = crop.region(whole.samples);
                // The number of the judge's decisions depends on the neighbouring samples.
                let told = |options| {
                    answers(prepared, &view, options, &pixel).map(|answers| {
                        answers
                            .into_iter()
                            .map(|mut answer| {
                                answer.work.judged_nearest = 0;
                                answer
                            })
                            .collect::<Vec<Answer>>()
                    })
                };
                assert_eq!(told(&alone), told(&whole), "{name} ({row}, {column})");
            }
        }
    }
}
