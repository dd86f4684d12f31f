//! The numbers that stand for the primitives of a scene in a file.

use super::encoding::IdEncoding;
use crate::common::Scene;
use std::cell::Cell;

/// The numbers that stand for the primitives of a scene.
pub(super) struct Numbering<'a> {
    scene: &'a Scene,
    encoding: IdEncoding,
    /// The object that was asked for last: its pixels lie beside each other.
    last: Cell<Option<Ids>>,
}

/// The ids of an object.
#[derive(Clone, Copy)]
struct Ids {
    object: u64,
    start: u64,
    end: u64,
}

impl<'a> Numbering<'a> {
    pub(super) fn new(scene: &'a Scene, encoding: IdEncoding) -> Numbering<'a> {
        Numbering { scene, encoding, last: Cell::new(None) }
    }

    /// The number that stands for a primitive; its id where names are its own.
    #[inline]
    pub(super) fn number(&self, id: u32) -> u64 {
        let id = u64::from(id);
        match self.encoding {
            IdEncoding::FromZero | IdEncoding::OneToOne => id,
            IdEncoding::CountedFrom(first) => first.saturating_add(id),
            IdEncoding::FromTheEnd => self.scene.primitive_count() - 1 - id,
            IdEncoding::OfObjects => self.object(id),
        }
    }

    fn object(&self, id: u64) -> u64 {
        if let Some(last) = self.last.get()
            && (last.start..last.end).contains(&id)
        {
            return last.object;
        }
        let object = self.scene.locate(id).0;
        let ids = self.scene.ids_of(object);
        self.last.set(Some(Ids { object: object as u64, start: ids.start, end: ids.end }));
        object as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes;

    #[test]
    fn every_primitive_has_the_number_of_its_encoding() {
        let scene = scenes::load("lecture").unwrap().scene;
        let count = scene.primitive_count();
        let forth = 0..u32::try_from(count).unwrap();
        let numbering = |encoding| Numbering::new(&scene, encoding);
        let objects = numbering(IdEncoding::OfObjects);
        // There and back: what was asked for last is of the same object, or of another one.
        for id in forth.clone().chain(forth.rev()) {
            let number = |encoding| numbering(encoding).number(id);
            assert_eq!(number(IdEncoding::FromZero), u64::from(id));
            assert_eq!(number(IdEncoding::CountedFrom(3)), u64::from(id) + 3);
            assert_eq!(number(IdEncoding::FromTheEnd), count - 1 - u64::from(id));
            assert_eq!(objects.number(id), scene.locate(id.into()).0 as u64);
        }
    }
}
