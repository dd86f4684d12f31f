//! Files with planted mistakes are graded.

use super::*;
use crate::common::{Camera, CameraDescription};
use crate::diff::foreign::Content;
use crate::scenes;

const SIZE: [u32; 2] = [60, 40];

/// The ids of the canonical scene.
fn ids() -> Vec<Option<u64>> {
    with_view(|view| {
        let like = Buffer::new(SIZE, 1, Content::Ids(vec![None; 2400]));
        let Content::Ids(ids) = truth(view, &like).unwrap().content().clone() else {
            panic!("ids were asked for");
        };
        ids
    })
}

fn with_view<T>(run: impl Fn(&View) -> T) -> T {
    let loaded = scenes::load("canonical").unwrap();
    let camera = Camera::new(CameraDescription { image: SIZE, ..loaded.camera }).unwrap();
    run(&View::new(&loaded.scene, &camera))
}

fn graded(ids: Vec<Option<u64>>) -> Grade {
    with_view(|view| grade(view, &Buffer::new(SIZE, 1, Content::Ids(ids.clone()))).unwrap())
}

#[test]
fn what_is_right_has_100() {
    let grade = graded(ids());
    assert_eq!((grade.verdict, grade.right, grade.score()), (Verdict::Right, grade.seen, 100.0));
    assert_eq!((grade.mistakes, grade.likely_mistake.as_str()), (0, ""));
}

#[test]
fn one_mistake_that_explains_all_gives_half_back() {
    let from_one = ids().into_iter().map(|id| id.map(|id| id + 1)).collect();
    let grade = graded(from_one);
    assert_eq!((grade.right, grade.explained), (0, grade.seen));
    assert_eq!((grade.verdict, grade.mistakes, grade.score()), (Verdict::Explained, 1, 50.0));
    assert_eq!(grade.likely_mistake, "it counts ids from 1: subtract 1");
}

#[test]
fn two_mistakes_give_a_quarter_back() {
    let rows: Vec<Vec<Option<u64>>> = ids().chunks(60).map(<[_]>::to_vec).collect();
    let both = rows.into_iter().rev().flatten().map(|id| id.map(|id| id + 1)).collect();
    let grade = graded(both);
    assert_eq!((grade.verdict, grade.mistakes), (Verdict::Explained, 2));
    #[expect(clippy::cast_precision_loss, reason = "few pixels")]
    let expected = 100.0 * (grade.right as f64 + grade.explained as f64 / 4.0) / grade.seen as f64;
    assert_eq!(grade.score(), (10.0 * expected).floor() / 10.0);
}

#[test]
fn what_is_not_explained_gives_nothing_back() {
    let mut dice = 1_u32;
    let noise = ids().into_iter().map(|id| {
        dice = dice.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        if dice >> 31 == 1 { Some(u64::from(dice >> 29)) } else { id }
    });
    let grade = graded(noise.collect());
    assert_eq!(grade.verdict, Verdict::Unexplained);
    assert_eq!((grade.explained, grade.mistakes), (0, 0), "{grade:?}");
    assert!(grade.score() < 75.0, "{grade:?}");
    let nothing = graded(vec![None; 2400]);
    assert_eq!((nothing.score(), nothing.mistakes), (0.0, 0));
    assert!(nothing.likely_mistake.starts_with("no evidence"), "{}", nothing.likely_mistake);
}

#[test]
fn a_single_wrong_pixel_is_never_100() {
    let mut nearly = ids();
    let at = nearly.iter().position(Option::is_some).unwrap();
    nearly[at] = None;
    let grade = graded(nearly);
    assert_eq!(grade.right + 1, grade.seen);
    assert!(grade.score() < 100.0 && grade.score() > 99.0);
}

#[test]
fn other_sizes_have_no_grade_and_perhaps_a_cause() {
    let of = |size: [u32; 2], ids: Vec<Option<u64>>| {
        with_view(|view| {
            let file = Buffer::new(size, 1, Content::Ids(ids.clone()));
            grade(view, &file).unwrap_err().to_string()
        })
    };
    let ids = ids();
    let exchanged = (0..2400).map(|at| ids[at % 40 * 60 + at / 40]).collect();
    let error = of([40, 60], exchanged);
    assert!(error.contains("40 x 60") && error.contains("rows and columns exchanged"), "{error}");
    let error = of([61, 40], vec![None; 61 * 40]);
    assert!(error.contains("a loop that includes its end"), "{error}");
    assert!(
        of([10, 10], vec![None; 100])
            .ends_with("and the scene 60 x 40; give --size as the file has it")
    );
}

#[test]
fn a_mistake_beside_others_is_explained_in_part() {
    // Counted from 1, and a quarter of the picture lost.
    let mut ids: Vec<_> = ids().into_iter().map(|id| id.map(|id| id + 1)).collect();
    let seen = ids.iter().flatten().count();
    let lost = ids.iter_mut().filter(|id| id.is_some()).skip(seen / 2).take(seen / 4);
    lost.for_each(|id| *id = None);
    let grade = graded(ids);
    assert_eq!((grade.verdict, grade.mistakes), (Verdict::PartlyExplained, 1), "{grade:?}");
    assert!(grade.likely_mistake.starts_with("it counts ids from 1"), "{grade:?}");
    assert!(grade.score() < 50.0 && grade.score() > 35.0, "{grade:?}");
}
