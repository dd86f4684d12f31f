//! Where a file differs from the true picture, if one thing of the scene is seen or shown in every such pixel.

use super::convention::{Convention, Placement, ShapeKind};
use super::drawn::Drawn;
use super::encoding::Encoding;
use super::expected::Expected;
use super::observed::{Observed, Values};
use crate::common::View;
use crate::common::frame::NO_PRIMITIVE;
use std::collections::BTreeSet;

/// What every wrong pixel shows, or should show, and what to do; as a sentence without its end. `None` if there is no such thing, or if nothing
/// else is shown rightly.
pub(super) fn common_place(view: &View, observed: &Observed, truth: &Drawn) -> Option<String> {
    let expected = Expected::new(view, &Convention::default(), truth);
    let mut places: Option<Vec<Thing>> = None;
    let mut right = BTreeSet::new();
    expected.each(observed, Placement::Upright, &Encoding::default(), |pixel, differs, _| {
        let seen = Some(truth.ids[pixel]).filter(|&id| id != NO_PRIMITIVE);
        if !differs {
            right.extend(seen);
            return;
        }
        let both = [seen, shown(view, observed, pixel)];
        let is_here = |thing: &Thing| both.iter().flatten().any(|&id| thing.holds(view, id));
        match &mut places {
            Some(places) => places.retain(is_here),
            None => {
                let all = both.iter().flatten().flat_map(|&id| Thing::all_of(view, id));
                places = Some(all.collect());
            }
        }
    });
    let places = places?;
    // Where nothing else is right, the file tells nothing of this thing.
    let is_one_of_many = |thing: &&Thing| right.iter().any(|&id| !thing.holds(view, id));
    let thing = places.iter().filter(is_one_of_many).min_by_key(|thing| thing.rank())?;
    Some(format!(
        "all wrong pixels lie on {}: look at how it is read, placed and tested",
        thing.words(view)
    ))
}

/// The primitive that the file shows, if it tells.
fn shown(view: &View, observed: &Observed, pixel: usize) -> Option<u32> {
    let Values::Ids(ids) = &observed.values else { return None };
    let id = ids[pixel].filter(|&id| id < view.scene.primitive_count())?;
    u32::try_from(id).ok()
}

/// Something in the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Thing {
    Primitive(u32),
    Object(usize),
    /// Any sphere, or any plane.
    Shape(ShapeKind),
}

impl Thing {
    /// What a primitive is a part of. That it is a triangle says nothing: most are.
    fn all_of(view: &View, id: u32) -> Vec<Thing> {
        let object = view.scene.locate(id.into()).0;
        let mut things = vec![Thing::Primitive(id), Thing::Object(object)];
        let shape = shape(view, id);
        things.extend((shape != ShapeKind::Triangle).then_some(Thing::Shape(shape)));
        things
    }

    fn holds(self, view: &View, id: u32) -> bool {
        match self {
            Thing::Primitive(own) => own == id,
            Thing::Object(object) => view.scene.ids_of(object).contains(&id.into()),
            Thing::Shape(own) => own == shape(view, id),
        }
    }

    /// Smaller for what says more.
    fn rank(self) -> u8 {
        match self {
            Thing::Primitive(_) => 0,
            Thing::Object(_) => 1,
            Thing::Shape(_) => 2,
        }
    }

    fn words(self, view: &View) -> String {
        match self {
            Thing::Primitive(id) => format!("id {id}, a {}", shape(view, id).name()),
            Thing::Object(object) => {
                let ids = view.scene.ids_of(object);
                format!("object {object} (ids {} to {})", ids.start, ids.end - 1)
            }
            Thing::Shape(shape) => format!("a {}", shape.name()),
        }
    }
}

fn shape(view: &View, id: u32) -> ShapeKind {
    ShapeKind::of(&view.primitive(id.into()))
}
