//! Numbers of a file that stand for primitives in an order of their own.

use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};

/// A name in the file for each primitive, as far as it was met. A first meeting explains nothing: it differs.
#[derive(Default)]
pub(super) struct Renaming {
    forth: HashMap<u32, u64>,
    back: HashMap<u64, u32>,
    /// Primitives that were met where the file has the name of another one.
    disputed: HashSet<u32>,
    contradicting: u64,
}

impl Renaming {
    /// Whether at least half of the primitives, and two of them, have another number than ours; and whether four of five have
    /// a name of their own: where one name stands for two primitives again and again, it is not one to one.
    pub(super) fn is_general(&self) -> bool {
        let renamed = self.forth.iter().filter(|&(&id, &name)| u64::from(id) != name).count();
        let nameless = self.disputed.iter().filter(|&id| !self.forth.contains_key(id)).count();
        renamed >= 2 && 2 * renamed >= self.forth.len() && 4 * nameless <= self.forth.len()
    }

    /// In how many pixels a primitive has another name than elsewhere, or the name of another one.
    pub(super) fn contradicting(&self) -> u64 {
        self.contradicting
    }

    pub(super) fn holds(&mut self, id: u32, name: u64) -> bool {
        match (self.forth.entry(id), self.back.entry(name)) {
            (Entry::Vacant(forth), Entry::Vacant(back)) => {
                forth.insert(name);
                back.insert(id);
                // Its own number needs no name.
                u64::from(id) == name
            }
            (Entry::Occupied(forth), Entry::Occupied(back)) => {
                let is_own = *forth.get() == name && *back.get() == id;
                self.contradicting += u64::from(!is_own);
                is_own
            }
            (Entry::Vacant(_), Entry::Occupied(_)) => {
                self.disputed.insert(id);
                self.contradicting += 1;
                false
            }
            (Entry::Occupied(_), Entry::Vacant(_)) => {
                self.contradicting += 1;
                false
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_exchanged_ids_are_no_numbering() {
        let named = |names: &[(u32, u64)]| {
            let mut renaming = Renaming::default();
            names.iter().for_each(|&(id, name)| _ = renaming.holds(id, name));
            renaming.is_general()
        };
        assert!(named(&[(0, 5), (1, 3), (2, 2)]));
        assert!(!named(&[(0, 0), (1, 1), (2, 2), (3, 4), (4, 3)]));
        assert!(!named(&[(0, 1)]));
    }

    #[test]
    fn one_number_for_two_primitives_is_no_numbering() {
        let general = |primitives: u32, name: fn(u32) -> u64| {
            let mut renaming = Renaming::default();
            (0..primitives).for_each(|id| _ = renaming.holds(id, name(id)));
            renaming.is_general()
        };
        assert!(general(12, |id| u64::from(11 - id)));
        // Two triangles are one square.
        assert!(!general(12, |id| u64::from(id / 2)));
        // One triangle of twelve is hidden behind another one's number.
        assert!(general(12, |id| u64::from(11 - id).max(1)));
    }

    #[test]
    fn a_renaming_is_held_to_its_first_names() {
        let mut renaming = Renaming::default();
        assert!(!renaming.holds(3, 7));
        assert!(renaming.holds(3, 7));
        assert!(!renaming.holds(4, 7));
        assert!(!renaming.holds(3, 8));
        assert!(renaming.holds(5, 5));
    }
}
