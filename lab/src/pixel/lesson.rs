//! A report on one pixel as text: the viewing ray, derived as on the board; what covers the pixel; what each order saw.

use super::SampleReport;
use crate::common::exact::{EdgeSigns, EdgeValues};
use crate::common::glam::Vec3;
use crate::common::{Camera, CameraDescription, Projection, Sign, Work};
use crate::orders::Order;
use crate::wording::{count, plain, readable, vector};
use std::fmt::Write;

/// A report on one pixel, in the words of the lecture and with the numbers of its camera.
#[derive(Clone, Copy, Debug)]
pub struct Lesson<'a> {
    /// The name of the scene.
    pub scene: &'a str,
    /// The camera.
    pub camera: &'a Camera,
    /// The pixel `[i, j]`, counted from 0.
    pub pixel: [u32; 2],
    /// Samples along one side of the pixel.
    pub along: u32,
    /// The report on each sample.
    pub samples: &'a [SampleReport],
}

impl Lesson<'_> {
    /// Whether both orders saw the true primitives.
    pub fn agrees(&self) -> bool {
        self.samples.iter().all(SampleReport::agrees)
    }

    /// The report as text: the viewing ray, derived; the primitives that cover the pixel; the results of both orders.
    pub fn text(&self) -> String {
        let ([i, j], [width, height]) = (self.pixel, self.camera.image());
        let mut text = format!("{}: pixel ({i}, {j}) of {width} x {height}", self.scene);
        text += ", row from the top, column from the left, counted from 0\n";
        let n = self.along;
        if n > 1 {
            text += &format!("the first of its {n} x {n} samples, at its top left\n");
        }
        let first = &self.samples[0];
        text += &self.derivation(first);
        text += &truth(first);
        text += &answers(first);
        if n > 1 {
            text += &seen(self.samples, n as usize);
        }
        text += if self.agrees() {
            "\nmatch: both orders saw what is nearest\n"
        } else {
            "\nDIFFERENCE: the orders did not both see what is nearest; please report this\n"
        };
        text
    }

    /// The lecture's formulas with this camera's numbers.
    fn derivation(&self, SampleReport { place: [x, y], ray, .. }: &SampleReport) -> String {
        let camera = self.camera;
        let CameraDescription { viewport: [vw, vh], image: [width, height], distance: d, .. } =
            *camera.description();
        // The formulas compute with `f64`: with this number of digits, a calculator gives the same result.
        let [vw, vh, d] = [vw, vh, d].map(f64::from);
        let ([i, j], n) = (self.pixel.map(|index| index + 1), self.along);
        // The middle of the pixel, or of the first of the n parts of its sides.
        let half = if n == 1 { "1/2".into() } else { format!("1 + 1/{}", 2 * n) };
        let direction = vector(plain(ray.direction));
        let [u, v, w] = [camera.u(), camera.v(), camera.w()].map(|axis| vector(plain(axis)));
        let eye = vector((camera.eye() + Vec3::ZERO).to_array());
        let rest = match camera.projection() {
            Projection::Perspective => format!(
                "  origin    = eye = {eye}\n  \
                 direction = x u + y v - d w, with d = {d}\n            = {direction}\n  \
                 t counts in lengths of the direction: t d is the depth along -w\n"
            ),
            Projection::Parallel => format!(
                "  origin    = eye + x u + y v = {eye}\n            + {}\n  \
                 direction = -w = {direction}\n  \
                 t is the depth along -w\n",
                vector(plain(ray.origin))
            ),
        };
        format!(
            "\nthe viewing ray, as the lecture writes it: it counts from 1, so that i = {i}, j = {j}\n  \
             x =  vw ((j - {half})/W - 1/2) =  {vw} (({j} - {half})/{width} - 1/2) = {x}\n  \
             y = -vh ((i - {half})/H - 1/2) = -{vh} (({i} - {half})/{height} - 1/2) = {y}\n  \
             u = {u}\n  v = {v}\n  w = {w}\n{rest}",
            x = x + 0.0,
            y = y + 0.0,
        )
    }
}

/// The primitives that cover the sample, near to far, and the primitives that only touch it.
fn truth(sample: &SampleReport) -> String {
    let mut text = match sample.covering.len() {
        0 => "\nno primitive covers it\n".into(),
        1 => "\n1 primitive covers it\n".into(),
        more => format!("\n{more} primitives cover it, near to far\n"),
    };
    if !(sample.covering.iter().all(|one| one.edges.is_none()) && sample.touching.is_empty()) {
        text += "a triangle covers a sample if its edge functions have the sign of its facing F; where one is \
                 0,\nthe sample is moved a little to the right, and less down: left and top edges own it\n";
    }
    for covering in &sample.covering {
        let (id, object, kind) = (covering.id, covering.object, covering.kind);
        let t = certain(covering.t);
        write!(text, "  id {id}: {kind}, object {object}, t = {t}").expect("a string takes all");
        let behind = covering.behind.map_or("seen", |behind| behind.words());
        text += &format!(" ({behind})\n");
        if let (Some(edges), Some(values)) = (&covering.edges, &covering.values) {
            text += &functions(edges, values);
        }
    }
    if !sample.touching.is_empty() {
        let triangles = count(sample.touching.len() as u64, "triangles");
        text += &format!(
            "\nexactly on an edge of {triangles}, but owned by its other side: not covered\n"
        );
        for touching in &sample.touching {
            text += &format!("  id {}: object {}\n", touching.id, touching.object);
            text += &functions(&touching.edges, &touching.values);
        }
    }
    text
}

/// `E_ab -0.5, E_bc 0 (tie: a left edge, nudged to -), E_ca -2`, and the facing for the comparison.
fn functions(edges: &EdgeSigns, values: &EdgeValues) -> String {
    let each = ["ab", "bc", "ca"].into_iter().enumerate();
    let words = each.map(|(index, name)| match values.sides[index] {
        Some(side) => {
            let (side, decided) = (side.name(), symbol(edges.decided[index]));
            format!("E_{name} 0 (tie: a {side} edge, nudged to {decided})")
        }
        None => format!("E_{name} {}", six_digits(values.at_sample[index])),
    });
    let words = words.collect::<Vec<_>>().join(", ");
    format!("    {words}; F {}\n", six_digits(values.facing))
}

/// The first six digits of a number.
fn six_digits(number: f64) -> String {
    readable::<f64>(format!("{number:.5e}").parse().expect("a number is written as a number"))
}

fn symbol(sign: Sign) -> &'static str {
    match sign {
        Sign::Negative => "-",
        Sign::Zero => "0",
        Sign::Positive => "+",
    }
}

/// The results of both orders, and their work.
fn answers(sample: &SampleReport) -> String {
    let orders = [(Order::Object, &sample.object_order), (Order::Image, &sample.image_order)];
    let mut text = String::from("\n");
    for (order, answer) in orders {
        let name = order.name();
        text += &match (answer.id, answer.t) {
            (Some(id), Some(t)) => format!("{name} saw id {id} at t = {t}\n"),
            _ => format!("{name} saw nothing\n"),
        };
        text += &format!("  {}\n", work(&answer.work));
    }
    text
}

fn work(work: &Work) -> String {
    let steps = [
        (work.primitives, "bounding regions", " around it"),
        (work.nodes, "box tests", ""),
        (work.tests, "primitive tests", ""),
        (work.fragments, "fragments", ""),
        (work.depth_tests, "depth comparisons", ""),
        (work.judged_coverage + work.judged_nearest, "questions", " to the exact judge"),
    ];
    let done = steps.iter().filter(|(number, ..)| *number > 0);
    let done: Vec<String> =
        done.map(|(number, things, rest)| count(*number, things) + rest).collect();
    if done.is_empty() { "nothing to do here".into() } else { done.join(", ") }
}

/// The visible ids at all samples, in the arrangement of the samples in the pixel.
fn seen(samples: &[SampleReport], n: usize) -> String {
    let word = |sample: &SampleReport| match sample.object_order.id {
        _ if !sample.agrees() => "differ".into(),
        Some(id) => id.to_string(),
        None => "-".into(),
    };
    let words: Vec<String> = samples.iter().map(word).collect();
    let width = words.iter().map(String::len).max().unwrap_or(0);
    let mut text = String::from("\nthe ids seen at all samples of the pixel\n");
    for row in words.chunks(n) {
        row.iter().for_each(|word| text += &format!("  {word:>width$}"));
        text.push('\n');
    }
    text
}

/// The ten certain digits of a distance, so that equal distances look equal.
pub(super) fn certain(t: f64) -> f64 {
    format!("{t:.9e}").parse().expect("a number is written as a number")
}
