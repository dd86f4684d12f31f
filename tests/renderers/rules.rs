//! The rules of ordinary renderers: each differs from the exact ones where it should, and nowhere else.

use bothways::common::glam::Vec3;
use bothways::common::{
    Camera, CameraDescription, Crop, Frame, Object, Options, Orientation, Plane, Projection, Scene,
    Shape, Sphere, Triangle, View,
};
use bothways::diff::compare;
use bothways::diff::foreign::{Buffer, Content};
use bothways::diff::why::{
    Change, Edges, Explanation, Finding, Placement, Rays, ReasonKind, Sampling, Wrong,
    find_conventions, find_reasons,
};
use bothways::orders::{self, Method, Order, RenderOptions, Rendered, Rule, Rules};
use bothways::picture::picture;
use bothways::rules::{image_order, object_order};
use bothways::scenes::load;
use bothways_test_support::hostile::{Numbers, for_each};

fn options(rules: Rules) -> RenderOptions<'static> {
    RenderOptions { rules, no_times: true, no_counts: true, ..RenderOptions::default() }
}

fn rendered(view: &View, order: Order, rules: Rules, frame: Options) -> Rendered {
    let options = RenderOptions { frame, ..options(rules) };
    orders::render(order, Method::Fast, view, &options).expect("the scene is in memory")
}

/// The frames of a rule and of the exact renderer of the same order.
fn both(view: &View, rule: Rule) -> [Frame; 2] {
    let order = rule.order();
    [rule.into(), Rules::default()]
        .map(|rules| rendered(view, order, rules, Options::default()).frame)
}

fn parse(text: &str) -> Rule {
    match text.parse() {
        Ok(rule) => Rule::Object(rule),
        Err(_) => Rule::Image(text.parse().expect("a rule")),
    }
}

#[test]
fn every_rule_differs_on_its_scene() {
    for rule in Rule::examples() {
        let loaded = load(rule.scene()).expect("it is built in");
        let camera = Camera::new(loaded.camera).expect("it is a camera");
        let view = View::new(&loaded.scene, &camera);
        let [ruled, exact] = both(&view, rule);
        let comparison = compare(&ruled, &exact);
        assert!(!comparison.matches(), "{rule:?} on {}", rule.scene());
        // Most of the picture still has to be recognisable, unless the convention moves all of it.
        let differing = comparison.classes().differing().count();
        let pixels = ruled.ids().len();
        let moves_all = ["flip-rows", "one-origin"].contains(&rule.about().form);
        assert!(moves_all || 2 * differing < pixels, "{rule:?}: {differing} of {pixels}");
    }
}

/// Triangles, a sphere and a plane in general position, large enough that no rounding matters.
fn plain_scene() -> Scene {
    let corners = [[-2.1, -1.3, -5.2], [1.7, -0.9, -4.1], [0.2, 1.9, -6.3], [2.9, 1.1, -7.7]];
    let [a, b, c, d] = corners.map(Vec3::from_array);
    let sphere = Sphere { center: Vec3::new(-1.9, 1.6, -6.0), radius: 0.9 };
    let plane = Plane { point: Vec3::new(0.0, -2.0, 0.0), normal: Vec3::new(0.05, 1.0, 0.1) };
    let shapes = [
        Shape::Triangle(Triangle { a, b, c }),
        Shape::Triangle(Triangle { a: b, b: d, c }),
        Shape::Sphere(sphere),
        Shape::Plane(plane),
    ];
    Scene::new(shapes.map(Object::from).into()).expect("it is a scene")
}

fn plain_camera(projection: Projection) -> Camera {
    let side = if projection == Projection::Parallel { 6.0 } else { 1.0 };
    Camera::new(CameraDescription {
        projection,
        eye: Vec3::new(0.1, 0.2, 0.3),
        orientation: Orientation::LookAt { target: Vec3::new(0.0, 0.0, -5.0), up: Vec3::Y },
        viewport: [side; 2],
        image: [61, 47],
        ..CameraDescription::default()
    })
    .expect("it is a camera")
}

#[test]
fn what_only_rounds_or_breaks_ties_equals_exact_where_nothing_is_close() {
    for projection in [Projection::Perspective, Projection::Parallel] {
        let (scene, camera) = (plain_scene(), plain_camera(projection));
        let view = View::new(&scene, &camera);
        for text in ["float32", "inclusive", "exclusive", "snapped:16", "near-clip:0.01", "depth24"]
        {
            let [ruled, exact] = both(&view, parse(text));
            assert_eq!(ruled.ids(), exact.ids(), "{text}, {projection:?}");
            assert_near(&ruled, &exact, text);
        }
        for text in ["moller-trumbore", "watertight", "float32"] {
            let rule = Rule::Image(text.parse().expect("a rule"));
            let [ruled, exact] = both(&view, rule);
            assert_eq!(ruled.ids(), exact.ids(), "{text}, {projection:?}");
            assert_near(&ruled, &exact, text);
        }
    }
}

/// Distances are those of `f32`; what is computed in `f64` is within the tolerance of the diff, colours, too.
fn assert_near(ruled: &Frame, exact: &Frame, text: &str) {
    let comparison = compare(ruled, exact);
    assert!(comparison.depth.max_relative_difference < 1e-4, "{text}: {:?}", comparison.depth);
    if ["inclusive", "exclusive", "near-clip:0.01", "depth24"].contains(&text) {
        assert_eq!(comparison.depth.differing_pixels, 0, "{text}: {:?}", comparison.depth);
        assert_eq!(comparison.color.differing_pixels, 0, "{text}: {:?}", comparison.color);
    }
}

#[test]
fn a_perspective_camera_has_one_origin() {
    let (scene, camera) = (plain_scene(), plain_camera(Projection::Perspective));
    let [ruled, exact] = both(&View::new(&scene, &camera), parse("one-origin"));
    assert_eq!(ruled.ids(), exact.ids());
    let camera = plain_camera(Projection::Parallel);
    let [ruled, exact] = both(&View::new(&scene, &camera), parse("one-origin"));
    assert!(ruled.ids().iter().all(|id| id == ruled.ids().get(0)));
    assert_ne!(ruled.ids(), exact.ids());
}

#[test]
fn flipped_rows_are_the_same_rows() {
    let (scene, camera) = (plain_scene(), plain_camera(Projection::Perspective));
    let [ruled, exact] = both(&View::new(&scene, &camera), parse("flip-rows"));
    for (row, column) in (0..47).flat_map(|row| (0..61).map(move |column| (row, column))) {
        assert_eq!(ruled.id(row, column), exact.id(46 - row, column));
        let [own, right] = [ruled.t(row, column), exact.t(46 - row, column)];
        let is_near = own.zip(right).is_none_or(|(own, right)| (own / right - 1.0).abs() < 1e-6);
        assert!(is_near, "{own:?} {right:?}");
    }
    let flipped = ruled.picture().chunks(61).rev().flatten().flatten();
    let most = flipped.zip(exact.picture().as_flattened()).map(|(one, other)| one.abs_diff(*other));
    assert!(most.max().is_some_and(|most| most <= 1));
}

#[test]
fn corners_are_sampled_half_a_pixel_up_and_left() {
    let half_square = |x: f32, y: f32| {
        let corner = |x, y| Vec3::new(x, y, -1.0);
        let (a, b, c) = (corner(x, y), corner(x + 0.25, y), corner(x, y - 0.25));
        Shape::Triangle(Triangle { a, b, c })
    };
    let scene = Scene::new(vec![half_square(-0.25, 0.25).into()]).expect("it is a scene");
    let camera = Camera::canonical(8, 8);
    let view = View::new(&scene, &camera);
    // The right angle is at the corner of pixel (2, 2), the legs are two pixels long: the legs own their samples, the
    // diagonal does not.
    for rule in [Rule::Object(object_order::Rule::Corner), Rule::Image(image_order::Rule::Corner)] {
        let [ruled, _] = both(&view, rule);
        let sketch: Vec<String> = (1..6)
            .map(|row| {
                let seen = |column| if ruled.id(row, column).is_some() { '#' } else { '.' };
                (1..6).map(seen).collect()
            })
            .collect();
        assert_eq!(sketch, [".....", ".##..", ".#...", ".....", "....."], "{rule:?}");
    }
}

#[test]
fn fill_rules_differ_on_ties_alone() {
    let loaded = load("ties").expect("it is built in");
    let camera = Camera::new(loaded.camera).expect("it is a camera");
    let view = View::new(&loaded.scene, &camera);
    let [inclusive, exact] = both(&view, parse("inclusive"));
    let exclusive = both(&view, parse("exclusive"))[0].clone();
    let covered = |frame: &Frame| frame.ids().covered();
    assert!(covered(&exclusive) < covered(&exact) && covered(&exact) < covered(&inclusive));
    // Snapping moves no vertex of this scene: each lies on a pixel's corner or middle.
    let snapped = both(&view, parse("snapped:8"))[0].clone();
    assert_eq!(snapped.ids(), exact.ids());
}

#[test]
fn what_is_near_is_cut_away() {
    let sphere = Shape::Sphere(Sphere { center: Vec3::new(0.0, 0.0, -2.0), radius: 1.0 });
    let scene = Scene::new(vec![sphere.into()]).expect("it is a scene");
    let camera = Camera::canonical(9, 9);
    let view = View::new(&scene, &camera);
    let seen = |text| both(&view, parse(text))[0].t(4, 4);
    assert_eq!(seen("near-clip:0.5"), Some(1.0));
    assert_eq!(seen("near-clip:1.5"), Some(3.0), "the inside");
    assert_eq!(seen("near-clip:4"), None);
}

#[test]
fn threads_and_crops_change_nothing() {
    let loaded = load("overlap").expect("it is built in");
    let camera = CameraDescription { image: [160, 120], ..loaded.camera };
    let camera = Camera::new(camera).expect("it is a camera");
    let view = View::new(&loaded.scene, &camera);
    for rule in Rule::examples() {
        let draw = |threads, crop| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let options = Options { samples: 2, crop };
            pool.install(|| rendered(&view, rule.order(), rule.into(), options).frame)
        };
        let whole = draw(1, None);
        assert_eq!(whole, draw(3, None), "{rule:?}");
        let crop = Crop { row: 37, column: 41, height: 11, width: 23 };
        let part = draw(2, Some(crop));
        let mut pixels = part.picture().iter();
        for [i, j] in part.pixels().map(|pixel| pixel.map(|index| index as usize)) {
            assert_eq!(pixels.next(), whole.picture().get(160 * i + j), "{rule:?} at {i}, {j}");
            let pairs = part.samples_of(i, j).zip(whole.samples_of(i, j));
            for (own, in_whole) in pairs {
                assert_eq!(part.ids().get(own), whole.ids().get(in_whole), "{rule:?} at {i}, {j}");
                assert_eq!(part.distances()[own], whole.distances()[in_whole]);
            }
        }
    }
}

#[test]
fn every_rule_survives_hostile_scenes() {
    for numbers in [Numbers::FewBits, Numbers::Ordinary, Numbers::Extreme] {
        for_each(numbers, 40, |view, frame| {
            for rule in Rule::examples() {
                let frame = rendered(view, rule.order(), rule.into(), *frame).frame;
                let ids = frame.ids().iter();
                assert!(ids.zip(frame.distances()).all(|(id, &t)| {
                    if id.is_none() { t == f32::INFINITY } else { t > 0.0 && t.is_finite() }
                }));
            }
        });
    }
}

/// What the diff must say of a rule.
enum Named {
    /// One of the best explanations has this part.
    Change(Change),
    /// Nine of ten differing pixels have one of these reasons.
    Reasons(&'static [ReasonKind]),
}

fn expected(rule: Rule) -> Named {
    use ReasonKind::{Clipped, DistanceRounding, DistanceTie, Elsewhere, Rounding, Tie};
    match rule {
        Rule::Object(rule) => match rule {
            object_order::Rule::Float32 | object_order::Rule::Snapped { .. } => {
                Named::Reasons(&[Rounding, Tie])
            }
            object_order::Rule::Inclusive => Named::Change(Change::Edges(Edges::Inclusive)),
            object_order::Rule::Exclusive => Named::Change(Change::Edges(Edges::Exclusive)),
            object_order::Rule::Corner => Named::Change(Change::Rows(Sampling::Corner)),
            object_order::Rule::NearClip { .. } => Named::Reasons(&[Clipped]),
            object_order::Rule::Depth24 => Named::Reasons(&[DistanceTie, DistanceRounding]),
        },
        Rule::Image(rule) => match rule {
            image_order::Rule::MollerTrumbore | image_order::Rule::Watertight => {
                Named::Change(Change::Edges(Edges::Inclusive))
            }
            image_order::Rule::Float32 => Named::Reasons(&[Rounding, Tie]),
            image_order::Rule::Corner => Named::Change(Change::Columns(Sampling::Corner)),
            image_order::Rule::OneOrigin => Named::Change(Change::Rays(Rays::OneOrigin)),
            image_order::Rule::FlipRows => Named::Change(Change::Placement(Placement::UpsideDown)),
            image_order::Rule::Jittered { .. } => {
                Named::Reasons(&[Elsewhere, Rounding, DistanceRounding])
            }
        },
    }
}

/// Asserts that the diff names every rule of an order on the rule's own scene.
fn check_names(order: Order) {
    for rule in Rule::examples().into_iter().filter(|rule| rule.order() == order) {
        let loaded = load(rule.scene()).expect("it is built in");
        let camera = Camera::new(loaded.camera).expect("it is a camera");
        let view = View::new(&loaded.scene, &camera);
        let frames = both(&view, rule);
        let pictures = frames.each_ref().map(picture);
        let [ruled, exact] = [0, 1].map(|side| Buffer::of_frame(&frames[side], &pictures[side]));
        match expected(rule) {
            Named::Change(change) => {
                let found = find_conventions(&view, &ruled).expect("it has ids").finding;
                let Finding::Explained(found) = found else { panic!("{rule}: {found:?}") };
                let is_named = |one: &Explanation| one.convention.changes().contains(&change);
                assert!(found.iter().any(is_named), "{rule}: {found:?}");
            }
            Named::Reasons(kinds) => {
                let comparison = compare(&frames[0], &frames[1]);
                let differing: Vec<[u32; 2]> =
                    comparison.classes().differing().map(|(pixel, _)| pixel).collect();
                let reasons = find_reasons(&view, &ruled, &exact, &differing).expect("of one size");
                assert!(reasons.pixels.iter().all(|one| one.wrong == Wrong::A), "{rule}");
                let named = reasons.pixels.iter().filter(|one| kinds.contains(&one.reason.kind()));
                let (named, all) = (named.count(), reasons.pixels.len());
                assert!(10 * named >= 9 * all, "{rule}: {named} of {all}, {:?}", reasons.counts());
            }
        }
    }
}

#[test]
fn the_diff_names_every_rule_of_object_order_on_its_scene() {
    check_names(Order::Object);
}

#[test]
fn the_diff_names_every_rule_of_image_order_on_its_scene() {
    check_names(Order::Image);
}

/// The ids of a frame, each row from right to left.
fn mirrored(frame: &Frame, [width, height]: [u32; 2]) -> Buffer<'static> {
    let rows = frame.ids().chunks(width as usize);
    let ids = rows.flat_map(|row| row.iter().rev());
    Buffer::new([width, height], 1, Content::Ids(ids.collect()))
}

/// Asserts that the diff names every rule of an order together with a second mistake: its rows run from right to left.
fn check_names_in_a_mirror(order: Order) {
    for rule in Rule::examples().into_iter().filter(|rule| rule.order() == order) {
        let loaded = load(rule.scene()).expect("it is built in");
        // What is left over pixel by pixel is so in a small picture, too.
        let divisor = if matches!(expected(rule), Named::Reasons(_)) { 4 } else { 1 };
        let image = loaded.camera.image.map(|side| side / divisor);
        let camera =
            Camera::new(CameraDescription { image, ..loaded.camera }).expect("it is a camera");
        let view = View::new(&loaded.scene, &camera);
        let [ruled, exact] = both(&view, rule);
        let file = mirrored(&ruled, camera.image());
        let found = find_conventions(&view, &file).expect("it has ids").finding;
        let Finding::Explained(found) = found else { panic!("{rule} in a mirror: {found:?}") };
        let by_rule =
            ruled.ids().iter().zip(exact.ids().iter()).filter(|(one, other)| one != other).count();
        // All pixels of one colour have no sides.
        let is_uniform = ruled.ids().iter().all(|id| id == ruled.ids().get(0));
        let is_named = |one: &Explanation| match expected(rule) {
            Named::Change(change) if is_uniform => one.convention.changes() == [change],
            // Upside down, too, makes it half a turn.
            Named::Change(Change::Placement(_)) => one.convention.placement == Placement::HalfTurn,
            Named::Change(change) => {
                one.convention.placement == Placement::LeftToRight
                    && one.convention.changes().contains(&change)
            }
            // What the rule itself does is left over, pixel by pixel.
            Named::Reasons(_) => {
                one.convention.placement == Placement::LeftToRight
                    && one.remaining <= by_rule as u64
            }
        };
        let found_instead: Vec<_> =
            found.iter().map(|one| (one.convention.changes(), one.remaining)).collect();
        assert!(
            found.iter().any(is_named),
            "{rule}, {by_rule} pixels by itself: {found_instead:?}"
        );
    }
}

#[test]
fn the_diff_names_every_rule_of_object_order_in_a_mirror() {
    check_names_in_a_mirror(Order::Object);
}

#[test]
fn the_diff_names_every_rule_of_image_order_in_a_mirror() {
    check_names_in_a_mirror(Order::Image);
}
