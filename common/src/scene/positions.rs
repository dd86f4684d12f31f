//! Positions of vertices, of which there may be very many.

use glam::Vec3;

/// Positions in blocks. The list grows without being copied, and never reserves more than one block.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Positions {
    blocks: Vec<Vec<Vec3>>,
}

/// How many positions one block holds.
const BLOCK: usize = 1 << 16;

impl Positions {
    /// Adds a position at the end.
    pub fn push(&mut self, position: Vec3) {
        match self.blocks.last_mut() {
            Some(block) if block.len() < BLOCK => block.push(position),
            _ => {
                let mut block = Vec::with_capacity(BLOCK);
                block.push(position);
                self.blocks.push(block);
            }
        }
    }

    /// The position of a vertex.
    ///
    /// # Panics
    ///
    /// If there is no such vertex.
    pub fn get(&self, vertex: u32) -> Vec3 {
        self.blocks[vertex as usize / BLOCK][vertex as usize % BLOCK]
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.blocks.last().map_or(0, |last| (self.blocks.len() - 1) * BLOCK + last.len())
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.blocks.is_empty()
    }

    /// All of them, in their order.
    pub fn iter(&self) -> impl Iterator<Item = Vec3> + Clone {
        self.blocks.iter().flatten().copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_are_found_across_blocks() {
        let mut positions = Positions::default();
        assert!(positions.is_empty());
        let count = u16::MAX as usize + 3;
        for k in 0..count {
            #[expect(clippy::cast_precision_loss, reason = "small numbers")]
            positions.push(Vec3::splat(k as f32));
        }
        assert_eq!(positions.len(), count);
        assert_eq!(positions.get(65_536).x, 65_536.0);
        assert!(positions.iter().zip(0_u32..).all(|(position, k)| positions.get(k) == position));
    }
}
