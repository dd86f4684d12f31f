//! The library's predicates against a judge that shares no code and no method with them: Cramer's
//! rule in exact numbers, the nudge a true polynomial in ε (see [`judge`]).
//!
//! Every family prints how much was judged. `BOTHWAYS_LONG=1` judges much more, from random seeds.

mod algebra;
mod cases;
mod judge;
mod near_misses;
mod round;

use bothways_common::exact::CachedJudge;
use bothways_common::glam::Vec3;
use bothways_common::{Camera, CameraDescription, Judge, Primitive, Ray, Shape, View};
use cases::{
    Case, Placement::Frame, Placement::Viewport, Placement::World, about_the_view, coplanar,
    edge_on, extreme_camera, fans, few_bit_camera, few_bits, few_bits_ahead, finite_vector,
    ordinary, pictures, slivers, soup, turned_camera,
};
use judge::IndependentJudge;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestRng, TestRunner};
use std::cell::Cell;
use std::cmp::Ordering;

/// How much was judged.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    /// Primitives at samples.
    decisions: u64,
    /// Of them, those that cover the sample.
    covered: u64,
    /// Samples exactly on a triangle's edge or corner, or where the ray touches a sphere.
    edge_ties: u64,
    /// Pairs of primitives that cover the same sample.
    comparisons: u64,
    /// Of them, those met at the same distance.
    distance_ties: u64,
}

impl Tally {
    fn plus(self, other: Tally) -> Tally {
        Tally {
            decisions: self.decisions + other.decisions,
            covered: self.covered + other.covered,
            edge_ties: self.edge_ties + other.edge_ties,
            comparisons: self.comparisons + other.comparisons,
            distance_ties: self.distance_ties + other.distance_ties,
        }
    }
}

/// Both judges of one camera.
struct Judges {
    library: Judge,
    truth: IndependentJudge,
}

impl Judges {
    fn new(camera: &Camera) -> Judges {
        Judges { library: Judge::new(camera), truth: IndependentJudge::new(camera) }
    }

    /// Confirms every answer about one sample, or says which one is wrong.
    fn confirm(
        &self,
        cached: &mut CachedJudge,
        primitives: &[(u32, Primitive)],
        ray: &Ray,
    ) -> Result<Tally, String> {
        let mut tally = Tally::default();
        let mut covering = Vec::new();
        for (id, primitive) in primitives {
            let truth = self.truth.coverage(primitive, ray);
            if self.library.covers(primitive, ray) != truth.covers {
                return Err(format!("coverage by {primitive:?} of {ray:?} is {truth:?}"));
            }
            let (test, coverage) =
                (self.library.test(primitive, ray), self.library.coverage(primitive, ray));
            if (test.covers, coverage.covers) != (truth.covers, truth.covers)
                || test.edge_signs != coverage.edges.map(|edges| edges.at_sample)
            {
                return Err(format!("{test:?} and {coverage:?} of {primitive:?} and {ray:?}"));
            }
            tally.decisions += 1;
            tally.edge_ties += u64::from(truth.on_edge);
            if truth.covers {
                self.confirm_distance(primitive, ray)?;
                covering.push((*id, primitive));
            }
        }
        tally.covered = covering.len() as u64;
        for (index, &first) in covering.iter().enumerate() {
            for &second in &covering[index + 1..] {
                tally.comparisons += 1;
                let tie = self.confirm_precedence(cached, first, second, ray)?;
                tally.distance_ties += u64::from(tie);
            }
        }
        Ok(tally)
    }

    /// Confirms which of two is seen, asked either way, fresh or remembering what was asked before;
    /// tells whether they tie.
    fn confirm_precedence(
        &self,
        cached: &mut CachedJudge,
        first: (u32, &Primitive),
        second: (u32, &Primitive),
        ray: &Ray,
    ) -> Result<bool, String> {
        let truth = self.truth.precedence(first, second, ray);
        let wide = |(id, primitive)| (u64::from(id), primitive);
        let answers = [
            self.library.nearer(wide(first), wide(second), ray),
            !self.library.nearer(wide(second), wide(first), ray),
            cached.nearer(first, second, ray),
            !cached.nearer(second, first, ray),
        ];
        if answers != [truth.first_is_seen; 4] {
            return Err(format!(
                "{first:?} before {second:?} on {ray:?} is {truth:?}, not {answers:?}"
            ));
        }
        Ok(truth.tie)
    }

    /// The rounded distance, to one part in a million.
    fn confirm_distance(&self, primitive: &Primitive, ray: &Ray) -> Result<(), String> {
        const RELATIVE: f64 = 1e-6;
        let t = self.library.distance(primitive, ray);
        let order = |t| self.truth.order_with(primitive, ray, t);
        let is_right = t.is_finite()
            && order(t * (1.0 - RELATIVE)) == Ordering::Greater
            && order(t * (1.0 + RELATIVE)) == Ordering::Less;
        if is_right { Ok(()) } else { Err(format!("distance {t} of {primitive:?} on {ray:?}")) }
    }
}

/// Confirms every answer about one picture.
fn confirm_case(case: &Case) -> Result<Tally, String> {
    let (camera, scene) = (case.camera(), case.scene());
    let judges = Judges::new(&camera);
    let primitives: Vec<_> = (0..)
        .zip(View::new(&scene, &camera).primitives().map(|(_, primitive)| primitive))
        .collect();
    let mut cached = CachedJudge::new(judges.library);
    case.rays().iter().try_fold(Tally::default(), |sum, ray| {
        Ok(sum.plus(judges.confirm(&mut cached, &primitives, ray)?))
    })
}

/// Confirms every answer about a family of pictures.
fn confirm(family: &str, cases: u32, pictures: impl Strategy<Value = Case>) -> Tally {
    let total = Cell::new(Tally::default());
    let result = runner(cases).run(&pictures, |case| {
        total.set(total.get().plus(confirm_case(&case).map_err(TestCaseError::fail)?));
        Ok(())
    });
    let tally = total.get();
    println!("{family}: {tally:?}");
    if let Err(error) = result {
        panic!("{family}: {error}");
    }
    assert!(tally.covered * 100 > tally.decisions, "{family} hardly covers anything: {tally:?}");
    tally
}

/// The same cases in every run, or many more and other ones if `BOTHWAYS_LONG` is set.
fn runner(cases: u32) -> TestRunner {
    let config = |cases| Config { cases, failure_persistence: None, ..Config::default() };
    if std::env::var_os("BOTHWAYS_LONG").is_some() {
        return TestRunner::new(config(20 * cases));
    }
    let seed = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    TestRunner::new_with_rng(config(cases), seed)
}

/// Fails if a family of ties has too few of them to prove anything.
fn assert_many_ties(tally: &Tally) {
    assert!(tally.edge_ties * 100 >= tally.decisions, "too few exact edge ties: {tally:?}");
    assert!(tally.distance_ties * 100 >= tally.comparisons, "too few distance ties: {tally:?}");
}

/// Shapes of every kind.
fn all(point: impl Strategy<Value = Vec3> + Clone + 'static) -> BoxedStrategy<Vec<Shape>> {
    let p = || point.clone();
    prop_oneof![soup(p()), fans(p()), coplanar(p()), slivers(p())].boxed()
}

/// Cameras of every ordinary kind.
fn any_camera() -> impl Strategy<Value = CameraDescription> {
    prop_oneof![few_bit_camera(), turned_camera()]
}

#[test]
fn random_pictures() {
    confirm("random", 1000, pictures(turned_camera(), all(about_the_view()), Viewport));
    confirm("random, in the world", 1000, pictures(turned_camera(), all(ordinary()), World));
}

#[test]
fn coordinates_with_few_bits() {
    let shapes = prop_oneof![soup(few_bits_ahead()), slivers(few_bits_ahead())];
    assert_many_ties(&confirm("few bits", 2000, pictures(few_bit_camera(), shapes, Frame)));
    let fans = pictures(few_bit_camera(), fans(few_bits_ahead()), Frame);
    assert_many_ties(&confirm("shared edges and silhouettes", 1200, fans));
    let coplanar = pictures(few_bit_camera(), coplanar(few_bits_ahead()), Frame);
    assert_many_ties(&confirm("coplanar and duplicate faces", 1200, coplanar));
}

#[test]
fn slivers_and_degenerate_triangles() {
    confirm("slivers", 1200, pictures(any_camera(), slivers(about_the_view()), Viewport));
    confirm("slivers of few bits", 1200, pictures(any_camera(), slivers(few_bits_ahead()), Frame));
}

#[test]
fn behind_the_eye_and_on_its_plane() {
    let flat = about_the_view().prop_map(|p| Vec3::new(p.x, p.y, p.z.round() * 0.5 - 0.5));
    confirm("behind", 1200, pictures(any_camera(), all(flat), Viewport));
}

#[test]
fn triangles_seen_edge_on() {
    confirm("edge-on", 1600, pictures(few_bit_camera(), edge_on(few_bits()), Frame));
    confirm("edge-on, turned", 800, pictures(turned_camera(), edge_on(about_the_view()), Frame));
}

#[test]
fn coplanar_faces_under_a_turned_camera() {
    let tally = confirm("turned", 1600, pictures(turned_camera(), coplanar(few_bits()), World));
    assert!(tally.distance_ties * 100 >= tally.comparisons, "too few ties: {tally:?}");
    confirm("turned, all shapes", 1000, pictures(turned_camera(), all(few_bits()), World));
}

#[test]
fn denormal_and_huge_coordinates() {
    confirm("from 1e-45 to 3e38", 2000, pictures(any_camera(), all(finite_vector()), World));
    let mixed = prop_oneof![few_bits(), finite_vector()].boxed();
    confirm("extremes among few bits", 1200, pictures(any_camera(), all(mixed), World));
}

#[test]
fn cameras_at_the_limits() {
    confirm("limits", 1600, pictures(extreme_camera(), all(about_the_view()), Viewport));
    let wild = prop_oneof![few_bits(), finite_vector()].boxed();
    confirm("limits, any numbers", 1200, pictures(extreme_camera(), all(wild), World));
}

#[test]
fn spheres_that_touch_and_meet_exactly() {
    let touched = confirm("touched spheres", 2000, round::touched());
    assert!(touched.edge_ties * 100 >= touched.decisions, "too few are touched: {touched:?}");
    let met = confirm("met at the same distance", 2000, round::met_at_one_point());
    assert!(met.distance_ties * 100 >= met.comparisons, "too few ties: {met:?}");
    confirm("the eye on or in a sphere", 1200, round::about_the_eye());
    confirm("huge and nearly touching spheres", 3000, round::huge_and_nearly_touching());
}
