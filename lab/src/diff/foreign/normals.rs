//! Which colours are normals.

/// Whether some of the vectors point to negative directions, and all of them are of unit length (to one part of a
/// hundred) or nothing. Colours are never like that.
pub(super) fn are_normals(vectors: impl IntoIterator<Item = [f32; 3]>) -> bool {
    let mut any_negative = false;
    for vector in vectors {
        let length = vector.iter().map(|part| f64::from(*part).powi(2)).sum::<f64>().sqrt();
        let is_nothing = vector == [0.0; 3] || !length.is_finite();
        if !is_nothing && (length - 1.0).abs() > 0.01 {
            return false;
        }
        any_negative |= vector.iter().any(|&part| part < 0.0);
    }
    any_negative
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_are_of_unit_length_and_some_point_backwards() {
        let nothing = [0.0; 3];
        assert!(are_normals([[0.0, 0.6, -0.8], nothing, [f32::NAN; 3], [1.0, 0.0, 0.0]]));
        assert!(!are_normals([[0.0, 0.6, 0.8], nothing]));
        // A filter with negative lobes leaves colours a little below black.
        assert!(!are_normals([[0.0, 0.6, -0.8], [0.5, -0.01, 0.2]]));
    }
}
