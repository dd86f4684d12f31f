//! Mistakes are planted one at a time and in pairs, and must be named.

mod blank;
mod credible;
mod framing;
mod layout;
mod missing;
mod stance;
mod stance_of_distances;
mod stance_of_mask;
mod vertices;

use super::draw::draw;
use super::drawn::Rows;
use super::*;
use crate::common::frame::NO_PRIMITIVE;
use crate::common::glam::Vec3;
use crate::common::{Camera, CameraDescription, Orientation, Primitive, Projection, View};
use crate::diff::buffer::{Buffer, Content};
use crate::formats::source::{GivenFile, InputFile};
use crate::scenes::{self, BUILT_IN, LoadedScene};

/// The file of a renderer with these conventions.
fn file(view: &View, convention: &Convention, of_ids: bool) -> Buffer<'static> {
    let drawn = draw(view, convention, Rows::ALL);
    let [width, height] = view.camera.image().map(|side| side as usize);
    let swaps = convention.placement.swaps_sides();
    let size = if swaps { [height, width] } else { [width, height] };
    let pixels = (0..width * height).map(|index| {
        let [i, j] =
            convention.placement.pixel([index / size[0], index % size[0]], [width, height]);
        drawn.ids[i * width + j]
    });
    let ids: Vec<Option<u64>> =
        pixels.map(|id| (id != NO_PRIMITIVE).then_some(id.into())).collect();
    let content = if of_ids {
        Content::Ids(ids)
    } else {
        Content::Mask(ids.iter().map(Option::is_some).collect::<Vec<_>>().into())
    };
    Buffer::new(size.map(|side| u32::try_from(side).unwrap()), 1, content)
}

fn with_scene(loaded: &LoadedScene, image: [u32; 2], projection: Projection, run: impl Fn(&View)) {
    let mut description = CameraDescription { projection, image, ..loaded.camera };
    description.viewport[0] = description.width_of_square_pixels();
    if projection == Projection::Parallel {
        description.viewport = description.viewport.map(|side| 3.0 * side);
    }
    let camera = Camera::new(description).unwrap();
    run(&View::new(&loaded.scene, &camera));
}

/// The camera with another `look_at` and `up`.
fn looking_at(description: CameraDescription, target: Vec3, up: Vec3) -> CameraDescription {
    CameraDescription { orientation: Orientation::LookAt { target, up }, ..description }
}

/// Whether the search names what was planted, besides nothing but what gives nearly the same picture; or says that
/// there is nothing to name, in a picture that is right or empty.
fn is_named(view: &View, planted: &Convention, of_ids: bool) -> bool {
    let file = file(view, planted, of_ids);
    let drawn = |convention: &Convention| {
        let upright = Convention { placement: Placement::Upright, ..*convention };
        draw(view, &upright, Rows::ALL).ids
    };
    let findings = find_conventions(view, &file).unwrap();
    let differing = findings.differing;
    match findings.finding {
        Finding::True => drawn(planted) == drawn(&Convention::default()),
        Finding::NoEvidence(_) => drawn(planted).iter().all(|&id| id == NO_PRIMITIVE),
        Finding::Explained(found) => {
            // A simpler convention that leaves less than a thousandth is better.
            let is_simpler = |one: &Explanation| {
                one.remaining * 1000 <= differing
                    && one.convention.changes().len() < planted.changes().len()
            };
            let is_planted = |one: &Explanation| one.convention == *planted && one.remaining == 0;
            found.iter().all(|one| one.remaining * 1000 <= differing)
                && found.iter().any(|one| is_planted(one) || is_simpler(one))
        }
        Finding::Rounded => planted.vertices != Vertices::Projected && differing < 4,
        Finding::Unexplained(_) => false,
    }
}

/// Triangles of both windings, one behind the other, and some behind the eye; no symmetry.
fn heap(projection: Projection, image: [u32; 2], run: impl Fn(&View)) {
    let mut dice = bothways_test_support::Dice(7);
    let mut objects: Vec<crate::common::Object> = Vec::new();
    for _ in 0..60 {
        let middle = 1.4 * dice.point();
        let mut corner = || middle + 0.6 * dice.point();
        let [a, b, c] = [corner(), corner(), corner()];
        objects.push(crate::common::Shape::Triangle(crate::common::Triangle { a, b, c }).into());
    }
    let scene = crate::common::Scene::new(objects).unwrap();
    let camera = CameraDescription {
        projection,
        eye: crate::common::glam::Vec3::new(0.3, 0.2, 1.1),
        viewport: [2.0, 1.5],
        image,
        ..CameraDescription::default()
    };
    let camera = Camera::new(camera).unwrap();
    run(&View::new(&scene, &camera));
}

/// Asserts that each pair of changes on different axes is named from ids.
fn check_every_pair(projection: Projection) {
    heap(projection, [32, 22], |view| {
        let mut changes = Change::of_rendering(view.camera);
        changes.retain(|change| change.is_coarse());
        changes.extend([Placement::UpsideDown, Placement::LeftToRight].map(Change::Placement));
        let mut missed = Vec::new();
        for (index, &one) in changes.iter().enumerate() {
            for &other in changes[..index].iter().filter(|other| one.is_paired_with(**other)) {
                let planted = Convention::default().with(other).with(one);
                if !is_named(view, &planted, true) {
                    missed.push(planted.changes());
                }
            }
        }
        assert!(missed.is_empty(), "{} {missed:#?}", missed.len());
    });
}

#[test]
fn every_pair_of_changes_on_different_axes_is_named_from_ids_in_perspective() {
    check_every_pair(Projection::Perspective);
}

#[test]
fn every_pair_of_changes_on_different_axes_is_named_from_ids_in_parallel() {
    check_every_pair(Projection::Parallel);
}

/// Triangles with corners in the middles of pixels and on the corners of pixels, many of them in one plane: most of their
/// edges meet samples exactly, and many samples see two of them equally far away.
fn lattice(run: impl Fn(&View)) {
    let mut dice = bothways_test_support::Dice(11);
    let mut objects: Vec<crate::common::Object> = Vec::new();
    for index in 0..14 {
        let depth = [8.0, 8.0, 8.0, 16.0][index % 4];
        let mut corner = || {
            let half = |at: f32, side: f32| (at * side).round() / 2.0;
            let at = dice.point();
            let middle = crate::common::glam::Vec3::new(half(at.x, 15.0), half(at.y, 11.0), -8.0);
            middle * (depth / 8.0)
        };
        let [a, b, c] = [corner(), corner(), corner()];
        objects.push(crate::common::Shape::Triangle(crate::common::Triangle { a, b, c }).into());
    }
    let scene = crate::common::Scene::new(objects).unwrap();
    let camera = CameraDescription {
        viewport: [16.0, 12.0],
        distance: 8.0,
        image: [16, 12],
        ..CameraDescription::default()
    };
    run(&View::new(&scene, &Camera::new(camera).unwrap()));
}

#[test]
fn every_rule_for_ties_is_named_from_ids_beside_every_change_on_another_axis() {
    lattice(|view| {
        let mut changes = Change::of_rendering(view.camera);
        changes.extend(Placement::ALL[1..3].iter().map(|&one| Change::Placement(one)));
        let (coarse, ties): (Vec<Change>, Vec<Change>) =
            changes.into_iter().partition(|change| change.is_coarse());
        let (mut missed, mut count) = (Vec::new(), 0);
        for &tie in &ties {
            for other in coarse.iter().filter(|other| tie.is_paired_with(**other)) {
                let planted = Convention::default().with(*other).with(tie);
                count += 1;
                if !is_named(view, &planted, true) {
                    missed.push(planted.changes());
                }
            }
        }
        assert!(missed.is_empty(), "{} of {count} {missed:?}", missed.len());
    });
}

/// The lecture's scene, with a teapot of so few triangles that many cover some samples of a small picture.
fn coarse_lecture() -> LoadedScene {
    let lecture = BUILT_IN.iter().find(|scene| scene.name == "lecture").unwrap();
    let coarse = lecture.toml.replace("divisions = [12, 12]", "divisions = [4, 4]");
    let file = GivenFile::new("coarse.toml", coarse.as_bytes());
    let loaded = scenes::load_file(&InputFile::given(&[file], 0), None).unwrap();
    assert!(loaded.scene.primitive_count() < 2000, "{}", loaded.scene.primitive_count());
    loaded
}

/// Asserts that each change alone is named from ids.
fn check_every_change(projection: Projection) {
    with_scene(&coarse_lecture(), [66, 44], projection, |view| {
        let mut changes = Change::of_rendering(view.camera);
        changes.extend(Placement::ALL[1..].iter().map(|&placement| Change::Placement(placement)));
        let mut poses = 0;
        for change in changes {
            let planted = Convention::default().with(change);
            let mut shown = draw(view, &planted, Rows::ALL).ids;
            shown.sort_unstable();
            shown.dedup();
            let is_pose = matches!(change, Change::Pose(_));
            // Many a wrong eye sees the floor alone, or nothing.
            if !is_pose || shown.iter().filter(|&&id| id != NO_PRIMITIVE).count() > 2 {
                assert!(is_named(view, &planted, true), "{change:?}");
                poses += usize::from(is_pose);
            }
        }
        assert!(poses > 5, "{poses}");
    });
}

#[test]
fn every_change_alone_is_named_from_ids_in_perspective() {
    check_every_change(Projection::Perspective);
}

#[test]
fn every_change_alone_is_named_from_ids_in_parallel() {
    check_every_change(Projection::Parallel);
}

#[test]
fn culled_faces_are_named_in_ids_and_in_distances() {
    let vector = crate::vectors::all().into_iter().find(|vector| vector.name == "winding").unwrap();
    let scene = vector.scene();
    let camera = CameraDescription { image: [64, 32], ..vector.camera };
    let camera = Camera::new(camera).unwrap();
    let view = View::new(&scene, &camera);
    let culled = Convention::default().with(Change::Faces(Faces::BackCulled));
    let [drawn, truth] = [culled, Convention::default()].map(|one| draw(&view, &one, Rows::ALL));
    let width = camera.image()[0];
    let number = |side: usize| u32::try_from(side).unwrap();
    let differing: Vec<[u32; 2]> = (0..truth.ids.len())
        .filter(|&index| truth.ids[index] != drawn.ids[index])
        .map(|index| [number(index) / width, number(index) % width])
        .collect();
    assert!(!differing.is_empty());
    let id = |&id: &u32| (id != NO_PRIMITIVE).then_some(u64::from(id));
    let files = [&drawn, &truth].map(|picture| {
        [Content::Ids(picture.ids.iter().map(id).collect()), Content::Distances(picture.t.clone())]
            .map(|content| Buffer::new(camera.image(), 1, content))
    });
    let [of_files, of_truth] = &files;
    for (file, truth) in of_files.iter().zip(of_truth) {
        let reasons = find_reasons(&view, file, truth, &differing).unwrap();
        // At its edges a tie or rounding explains as much.
        let culled = reasons.count_of(|kind| kind == ReasonKind::Culled);
        let close = reasons.count_of(|kind| matches!(kind, ReasonKind::Tie | ReasonKind::Rounding));
        assert_eq!(culled + close, differing.len() as u64, "{:?}", reasons.counts());
        assert!(culled > 4 * close, "{}: {:?}", file.kind(), reasons.counts());
    }
}

#[test]
fn what_explains_a_third_is_a_guess() {
    let loaded = scenes::load("ties").unwrap();
    with_scene(&loaded, [64, 64], Projection::Perspective, |view| {
        let planted = Convention::default().with(Change::Edges(Edges::Inclusive));
        let [truth, drawn] =
            [Convention::default(), planted].map(|one| draw(view, &one, Rows::ALL).ids);
        let mut ids: Vec<Option<u64>> =
            drawn.iter().map(|&id| (id != NO_PRIMITIVE).then_some(id.into())).collect();
        let by_planted = (0..ids.len()).filter(|&at| drawn[at] != truth[at]).count();
        // Twice as many pixels are wrong for no reason.
        let elsewhere = (0..ids.len()).map(|k| 1021 * k % ids.len());
        let others: Vec<usize> = elsewhere.filter(|&at| drawn[at] == truth[at]).collect();
        assert!(by_planted > 10 && others.len() > 2 * by_planted);
        for (k, &at) in others[..2 * by_planted].iter().enumerate() {
            ids[at] = Some(1_000_000 + k as u64);
        }
        let file = Buffer::new(view.camera.image(), 1, Content::Ids(ids));
        let findings = find_conventions(view, &file).unwrap();
        let Finding::Explained(found) = &findings.finding else { panic!("{findings:?}") };
        assert!(found.iter().any(|one| one.convention == planted), "{found:?}");
        assert!(found.iter().all(|one| one.is_a_guess(findings.differing)), "{found:?}");
    });
}

#[test]
fn a_pixel_that_is_right_by_accident_hides_no_mistake() {
    heap(Projection::Perspective, [32, 22], |view| {
        for faces in [Faces::BackCulled, Faces::FrontCulled] {
            let planted = Convention::default().with(Change::Faces(faces));
            let [truth, drawn] =
                [Convention::default(), planted].map(|one| draw(view, &one, Rows::ALL).ids);
            let mut ids: Vec<Option<u64>> =
                drawn.iter().map(|&id| (id != NO_PRIMITIVE).then_some(id.into())).collect();
            let culled: Vec<usize> = (0..ids.len()).filter(|&at| drawn[at] != truth[at]).collect();
            assert!(culled.len() > 50);
            for &at in &[culled[7], culled[40]] {
                ids[at] = Some(truth[at].into());
            }
            let file = Buffer::new(view.camera.image(), 1, Content::Ids(ids));
            let finding = find_conventions(view, &file).unwrap().finding;
            let Finding::Explained(found) = &finding else { panic!("{finding:?}") };
            assert!(found.iter().any(|one| one.convention == planted), "{found:?}");
        }
    });
}

#[test]
fn what_a_file_shows_rightly_is_not_wrong_by_an_explanation() {
    let loaded = scenes::load("canonical").unwrap();
    with_scene(&loaded, [64, 64], Projection::Perspective, |view| {
        let truth = draw(view, &Convention::default(), Rows::ALL);
        // Four fifths of the picture are lost: less is wrong in a picture of nothing than in the true one.
        let is_kept = |pixel: usize| (pixel * 7919).is_multiple_of(5);
        let shown = |(pixel, &id): (usize, &u32)| {
            (id != NO_PRIMITIVE && is_kept(pixel)).then_some(u64::from(id))
        };
        let ids: Vec<Option<u64>> = truth.ids.iter().enumerate().map(shown).collect();
        assert!(ids.iter().any(Option::is_some));
        let holes = Buffer::new([64, 64], 1, Content::Ids(ids));
        let finding = find_conventions(view, &holes).unwrap().finding;
        assert_eq!(finding, Finding::Unexplained(None));
    });
}

/// The distances of what is seen, ascending.
fn seen_distances(view: &View) -> Vec<f64> {
    let drawn = draw(view, &Convention::default(), Rows::ALL);
    let mut seen: Vec<f64> = drawn.t.into_iter().filter(|t| t.is_finite()).collect();
    seen.sort_by(f64::total_cmp);
    seen
}

#[test]
fn planes_that_clip_are_named_with_their_distances() {
    let check = |view: &View| {
        let seen = seen_distances(view);
        for twentieth in [1, 4, 10, 16, 18] {
            let t = seen[seen.len() * twentieth / 20].next_up();
            let at = Between { nearer: t, farther: t };
            let clip = Clip { at, alone: None };
            let near = |hides_spheres: bool| Change::Near(NearPlane { clip, hides_spheres });
            for change in [near(false), near(true), Change::Far(clip)] {
                let planted = Convention::default().with(change);
                let findings = find_conventions(view, &file(view, &planted, true)).unwrap();
                let differing = findings.differing;
                let Finding::Explained(found) = findings.finding else {
                    panic!("{twentieth} {change:?}: {findings:?}")
                };
                let holds = |between: Option<Between>| {
                    between.is_some_and(|one| one.nearer <= t && t <= one.farther)
                };
                let is_named = |one: &Explanation| match change {
                    Change::Near(_) => holds(one.convention.near.map(|plane| plane.clip.at)),
                    _ => holds(one.convention.far.map(|clip| clip.at)),
                };
                assert!(found.iter().any(is_named), "{twentieth} {change:?}: {found:?}");
                // What lies behind may be seen in the gap between the two distances.
                let is_good = |one: &Explanation| one.remaining * 20 <= differing;
                assert!(found.iter().all(is_good), "{twentieth} {change:?}: {found:?}");
            }
        }
    };
    for projection in [Projection::Perspective, Projection::Parallel] {
        heap(projection, [64, 44], check);
        with_scene(&coarse_lecture(), [66, 44], projection, check);
    }
}

#[test]
fn what_is_left_out_is_named_in_ids_and_in_masks() {
    let check = |view: &View, of_ids: bool| {
        let truth = draw(view, &Convention::default(), Rows::ALL);
        let mut seen = truth.ids;
        seen.sort_unstable();
        let pixels = seen.chunk_by(PartialEq::eq).filter(|one| one[0] != NO_PRIMITIVE);
        let large: Vec<u32> = pixels.filter(|one| one.len() > 7).map(|one| one[0]).collect();
        assert!(large.len() > 10);
        let mut omissions: Vec<Omission> =
            large.iter().map(|&id| Omission::of_primitive(view.scene, id)).collect();
        omissions.extend(
            (0..view.scene.objects().len())
                .filter_map(|object| Omission::of_object(view.scene, object)),
        );
        if of_ids {
            omissions.push(Omission::From { least: 0, first: large[large.len() / 2] });
        }
        let same = |one: Omission, other: Omission| {
            let mut all = (0..).zip(view.primitives());
            all.all(|(id, (_, primitive))| one.omits(id, &primitive) == other.omits(id, &primitive))
        };
        let (mut named, mut wrong) = (0, 0);
        for omission in omissions {
            let planted = Convention::default().with(Change::Omission(omission));
            let findings = find_conventions(view, &file(view, &planted, of_ids)).unwrap();
            match findings.finding {
                // In a mask, what lies behind hides it.
                Finding::True => assert!(!of_ids, "{omission:?}"),
                Finding::Explained(found) => {
                    let least = found.iter().map(|one| one.remaining).min();
                    assert_eq!(least, Some(0), "{omission:?}: {found:?}");
                    let is_it = |one: &Explanation| same(one.convention.omission, omission);
                    named += usize::from(found.iter().any(is_it));
                    // What has a name is not listed by its ids, too.
                    let of = |one: &Explanation| one.convention.omission;
                    let is_list = |one: &Omission| matches!(one, Omission::Several(_));
                    for list in found.iter().map(of).filter(is_list) {
                        let like_it = found.iter().filter(|one| same(of(one), list)).count();
                        assert_eq!(like_it, 1, "{found:?}");
                    }
                    wrong += 1;
                }
                // So few pixels may be lost by rounding.
                Finding::Unexplained(_) if findings.differing < 8 => assert!(!of_ids),
                other => panic!("{omission:?}: {other:?}"),
            }
        }
        // The masks of several omissions may be the same.
        assert!(named == wrong || (!of_ids && 2 * named > wrong), "{named} of {wrong}");
    };
    heap(Projection::Perspective, [64, 44], |view| {
        check(view, true);
        check(view, false);
    });
    with_scene(&coarse_lecture(), [66, 44], Projection::Perspective, |view| check(view, true));
}

#[test]
fn what_is_shown_elsewhere_is_not_left_out() {
    heap(Projection::Perspective, [64, 44], |view| {
        let truth = draw(view, &Convention::default(), Rows::ALL).ids;
        let mut seen = truth.clone();
        seen.sort_unstable();
        let pixels = seen.chunk_by(PartialEq::eq).filter(|one| one[0] != NO_PRIMITIVE);
        let largest = pixels.max_by_key(|one| one.len()).unwrap()[0];
        // The largest triangle is shown, but upside down.
        let planted = Convention::default()
            .with(Change::Omission(Omission::of_primitive(view.scene, largest)));
        let mut ids: Vec<Option<u64>> = draw(view, &planted, Rows::ALL)
            .ids
            .iter()
            .map(|&id| (id != NO_PRIMITIVE).then_some(id.into()))
            .collect();
        for (index, _) in truth.iter().enumerate().filter(|(_, id)| **id == largest) {
            let [i, j] = [index / 64, index % 64];
            ids[(43 - i) * 64 + j] = Some(largest.into());
        }
        let file = Buffer::new([64, 44], 1, Content::Ids(ids));
        if let Finding::Explained(found) = find_conventions(view, &file).unwrap().finding {
            let is_claimed = |one: &Explanation| one.convention.omission != Omission::Nothing;
            assert!(!found.iter().any(is_claimed), "{found:?}");
        }
    });
}

#[test]
fn where_one_thing_is_wrong_it_is_named_and_no_cause_is_guessed() {
    let loaded = scenes::load("canonical").unwrap();
    with_scene(&loaded, [64, 64], Projection::Perspective, |view| {
        let truth = draw(view, &Convention::default(), Rows::ALL);
        let sphere = (0..).zip(view.primitives()).find_map(|(id, (_, primitive))| {
            matches!(primitive, Primitive::Sphere { .. }).then_some(id)
        });
        let sphere: u32 = sphere.unwrap();
        // Distances that no formula of `t` gives, on the sphere alone.
        let other = |(&id, &t): (&u32, &f64)| if id == sphere { t.sin() + 2.0 } else { t };
        let t: Vec<f64> = truth.ids.iter().zip(&truth.t).map(other).collect();
        let file = Buffer::new([64, 64], 1, Content::Distances(t));
        let finding = find_conventions(view, &file).unwrap().finding;
        let place = format!(
            "all wrong pixels lie on id {sphere}, a sphere: look at how it is read, placed and tested"
        );
        assert_eq!(finding, Finding::Unexplained(Some(place)));
    });
}

#[test]
fn distances_that_are_a_linear_function_are_named() {
    with_scene(&coarse_lecture(), [66, 44], Projection::Perspective, |view| {
        let truth = draw(view, &Convention::default(), Rows::ALL);
        for (factor, offset) in [(3.0, 0.0), (1.0, -1.0), (0.5, 3.0), (-3.0, 1.0)] {
            let t: Vec<f64> = truth.t.iter().map(|t| factor * t + offset).collect();
            let file = Buffer::new(view.camera.image(), 1, Content::Distances(t));
            let Finding::Explained(found) = find_conventions(view, &file).unwrap().finding else {
                panic!("{factor} {offset}")
            };
            let DistanceEncoding::Linear { factor: f, offset: o } = found[0].encoding.distances
            else {
                panic!("{found:?}")
            };
            assert!((f - factor).abs() < 1e-6 && (o - offset).abs() < 1e-5, "{f} {o}");
            assert_eq!((found.len(), found[0].remaining), (1, 0));
        }
    });
}

/// The file whose number for each primitive is what `number` makes of its id.
fn numbered(view: &View, number: impl Fn(u32) -> u64) -> Buffer<'static> {
    let truth = draw(view, &Convention::default(), Rows::ALL).ids;
    let ids = truth.iter().map(|&id| (id != NO_PRIMITIVE).then(|| number(id)));
    Buffer::new(view.camera.image(), 1, Content::Ids(ids.collect()))
}

#[test]
fn a_numbering_from_another_number_is_named() {
    with_scene(&coarse_lecture(), [66, 44], Projection::Perspective, |view| {
        for first in [1, 2, 5, 1 << 40] {
            let file = numbered(view, |id| first + u64::from(id));
            let finding = find_conventions(view, &file).unwrap().finding;
            let Finding::Explained(found) = &finding else { panic!("{finding:?}") };
            let expected = IdEncoding::CountedFrom(first);
            assert_eq!((found.len(), found[0].encoding.ids), (1, expected), "{found:?}");
            assert_eq!(found[0].remaining, 0);
        }
        // An object too many moves those behind it only: nearly all, or the floor alone.
        let mut ids = draw(view, &Convention::default(), Rows::ALL).ids;
        ids.retain(|&id| id != NO_PRIMITIVE);
        ids.sort_unstable();
        let finding_of = |first_moved: u32| {
            let moved = |id: u32| u64::from(id) + if id < first_moved { 0 } else { 5 };
            find_conventions(view, &numbered(view, moved)).unwrap().finding
        };
        let finding = finding_of(ids[ids.len() / 66]);
        let Finding::Explained(found) = &finding else { panic!("{finding:?}") };
        let is_one_to_one = |one: &Explanation| one.encoding.ids == IdEncoding::OneToOne;
        assert!(found.iter().all(is_one_to_one), "{finding:?}");
        let floor = ids[ids.len() - 1];
        let place = format!(
            "all wrong pixels lie on id {floor}, a plane: look at how it is read, placed and tested"
        );
        assert_eq!(finding_of(floor), Finding::Unexplained(Some(place)));
    });
}

#[test]
fn a_file_of_one_number_says_nothing() {
    with_scene(&coarse_lecture(), [66, 44], Projection::Perspective, |view| {
        let truth = draw(view, &Convention::default(), Rows::ALL).ids;
        let zero = |&id: &u32| (id != NO_PRIMITIVE).then_some(0);
        let content = Content::Ids(truth.iter().map(zero).collect());
        let file = Buffer::new(view.camera.image(), 1, content);
        let finding = find_conventions(view, &file).unwrap().finding;
        assert!(matches!(finding, Finding::NoEvidence(_)), "{finding:?}");
    });
}

#[test]
fn a_large_number_for_nothing_is_named() {
    heap(Projection::Perspective, [64, 44], |view| {
        let truth = draw(view, &Convention::default(), Rows::ALL).ids;
        let number = |&id: &u32| Some(if id == NO_PRIMITIVE { 255 } else { id.into() });
        let file = Buffer::new([64, 44], 1, Content::Ids(truth.iter().map(number).collect()));
        let finding = find_conventions(view, &file).unwrap().finding;
        let Finding::Explained(found) = &finding else { panic!("{finding:?}") };
        let nothing = NothingEncoding::Number(255.0);
        assert_eq!((found.len(), found[0].encoding.nothing), (1, nothing), "{found:?}");
    });
}
