//! Whether a file can tell conventions at all.

use super::convention::Convention;
use super::drawn::Drawn;
use super::encoding::NothingEncoding;
use super::observed::{Observed, Values};
use super::rays::ViewingRays;
use crate::common::frame::NO_PRIMITIVE;
use crate::common::{Projection, View};
use crate::diff::buffer::{Buffer, Content, Covered};
use crate::diff::foreign::{are_many, whole_numbers};
use std::collections::HashSet;

/// Why the file cannot tell conventions, if it cannot.
pub(super) fn no_evidence(
    view: &View,
    file: &Buffer,
    observed: &Observed,
    truth: &Drawn,
) -> Option<String> {
    let pixels = truth.ids.len() as u64;
    let covered = observed.covered_count(NothingEncoding::Ours);
    let seen = truth.ids.iter().filter(|&&id| id != NO_PRIMITIVE).count();
    if are_ids(observed, truth) {
        Some(
            "all its numbers are whole, as of ids that are saved as floating-point numbers (save them as integers, \
             astype('uint32')), or of depths in whole steps"
                .into(),
        )
    } else if covered == 0 {
        Some(
            "the file covers nothing, as where a renderer looks the other way (along +w) or from another place, culls or \
             clips everything, never hits, or clears its depth buffer to 0, so that nothing is ever nearer"
                .into(),
        )
    } else if seen == 0 {
        Some("the scene covers no pixel of this camera: are scene, camera and size those of the file?".into())
    } else if let Some(number) = only_number(view, observed, truth) {
        Some(format!(
            "every pixel that it covers holds the number {number}, though several objects are seen: are its ids written?"
        ))
    } else if matches!(observed.values, Values::Mask(_)) && covered == pixels {
        Some(match has_background(file) {
            true => "no pixel has the colour of the background: is it another colour there, or are red and blue exchanged?",
            false => "the mask covers every pixel, and so says nothing about conventions; compare ids",
        }.into())
    } else {
        None
    }
}

/// Whether a file of distances has many whole numbers alone, where hardly a true distance is one.
fn are_ids(observed: &Observed, truth: &Drawn) -> bool {
    let Values::Distances(numbers) = &observed.values else { return false };
    let seen = || truth.t.iter().filter(|t| t.is_finite());
    let whole = seen().filter(|t| t.fract() == 0.0).count();
    8 * whole <= seen().count() && whole_numbers(numbers).is_some_and(|ids| are_many(&ids))
}

/// Whether the colour of its background tells what a picture covers.
fn has_background(file: &Buffer) -> bool {
    let Content::Picture(picture) = file.content() else { return false };
    matches!(picture.covered, Covered::ByBackground(_))
}

/// The number that a file of ids holds wherever it covers something, if several objects are seen there, and it is no id, or the
/// first one, and its primitive does not lie everywhere behind them.
fn only_number(view: &View, observed: &Observed, truth: &Drawn) -> Option<u64> {
    let Values::Ids(ids) = &observed.values else { return None };
    let number = ids.iter().flatten().next().copied()?;
    let seen = &truth.ids;
    let objects: HashSet<usize> = seen
        .iter()
        .filter(|&&id| id != NO_PRIMITIVE)
        .map(|&id| view.scene.locate(id.into()).0)
        .collect();
    let is_constant = objects.len() > 1
        && ids.len() == seen.len()
        && ids.iter().flatten().all(|&id| id == number)
        && ids.iter().zip(seen).all(|(id, seen)| id.is_some() || *seen == NO_PRIMITIVE);
    // Parallel rays of one origin see one primitive in all pixels.
    let may_be_one_ray =
        view.camera.projection() == Projection::Parallel && ids.iter().all(Option::is_some);
    let count = view.scene.primitive_count();
    let is_no_id = number == 0 || number >= count;
    // Ids may count from 1.
    let ids_of_number = [Some(number), number.checked_sub(1)].into_iter().flatten();
    let is_behind_all =
        || ids_of_number.filter(|&id| id < count).any(|id| lies_everywhere(view, truth, id));
    (is_constant && is_no_id && !may_be_one_ray && !is_behind_all()).then_some(number)
}

/// Whether a primitive covers every sample at which something is seen.
fn lies_everywhere(view: &View, truth: &Drawn, id: u64) -> bool {
    let (rays, primitive) =
        (ViewingRays::new(view.camera, &Convention::default()), view.primitive(id));
    let (judge, width) = (rays.judge(), rays.x.len());
    let mut pixels = (0..truth.ids.len()).filter(|&at| truth.ids[at] != NO_PRIMITIVE);
    pixels.all(|pixel| judge.covers(&primitive, &rays.ray(pixel / width, pixel % width)))
}
