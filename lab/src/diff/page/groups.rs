//! Groups of differing pixels: each has a name, a colour, and a box to tick in the page.

use crate::diff::aspect::Aspect;
use crate::diff::classes::Class;
use crate::diff::compare::BufferComparison;
use crate::diff::tolerance::Tolerances;

/// Some of the differing pixels: a class, or a reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Group {
    /// The name in the list of groups, in a few words.
    pub name: String,
    /// What the group means, in a sentence.
    pub explanation: Option<String>,
    /// The colour of its pixels in the difference image, in sRGB.
    pub color: [u8; 3],
    /// The pixels `[i, j]`, in any order, counted as by [`Classes::differing`](crate::diff::Classes::differing).
    pub pixels: Vec<[u32; 2]>,
}

impl Group {
    /// The classes of differing pixels that occur, from the worst.
    pub fn of_classes(comparison: &BufferComparison) -> Vec<Group> {
        let differing = Class::ALL.into_iter().filter(|class| class.differs());
        let mut groups: Vec<(Class, Group)> =
            differing.map(|class| (class, Group::of_class(class, comparison))).collect();
        for (pixel, class) in comparison.classes().differing() {
            let group = groups.iter_mut().find(|(of, _)| *of == class);
            group.expect("every differing class has a group").1.pixels.push(pixel);
        }
        groups
            .into_iter()
            .map(|(_, group)| group)
            .filter(|group| !group.pixels.is_empty())
            .collect()
    }

    /// The group of a class, still without pixels.
    fn of_class(class: Class, comparison: &BufferComparison) -> Group {
        let (name, explanation) = match class {
            Class::OnlyObjectOrder => ("covered in A only".into(), None),
            Class::OnlyImageOrder => ("covered in B only".into(), None),
            _ => other_values(&comparison.compared, &comparison.tolerances),
        };
        Group { name, explanation, color: class.color(), pixels: Vec::new() }
    }
}

/// The name of the pixels that agree in coverage, or whose coverage is unknown, and what makes them differ.
fn other_values(compared: &[Aspect], tolerances: &Tolerances) -> (String, Option<String>) {
    let Tolerances { t, normals, color } = tolerances;
    let of = |aspect: &Aspect| match aspect {
        Aspect::Ids => Some(("ids", None)),
        Aspect::T => Some(("t", Some(format!("t beyond {t:e} of the larger")))),
        Aspect::Color => Some(("colours", Some(format!("a colour beyond {color}/255")))),
        Aspect::Normals => Some(("normals", Some(format!("normals more than {normals}° apart")))),
        Aspect::Coverage => None,
    };
    let (names, meanings): (Vec<_>, Vec<_>) = compared.iter().filter_map(of).unzip();
    let meanings: Vec<String> = meanings.into_iter().flatten().collect();
    let place = if compared.contains(&Aspect::Coverage) { "in both, other " } else { "other " };
    let explanation = (!meanings.is_empty()).then(|| meanings.join(", or "));
    (place.to_owned() + &names.join(" or "), explanation)
}
