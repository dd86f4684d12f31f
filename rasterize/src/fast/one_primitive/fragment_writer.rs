//! Writes the fragments of one primitive into a tile.

use crate::fast::fragments::Fragments;
use crate::fast::many_samples;
use crate::fast::picture::{Picture, judge_covers};
use crate::fast::setup::FlatSetup;
use crate::fast::thin;
use crate::fast::tile::{Incoming, TileBuffer};
use bothways_common::Primitive;
use bothways_common::engine::context::{Context, ScalarContext};
use bothways_common::engine::roundoff::Interval;
use bothways_common::engine::simd::apart;
use bothways_common::raster::Sample;

/// Writes fragments of one primitive into a tile.
pub(crate) struct FragmentWriter<'a, 'b> {
    /// Its name.
    pub(crate) id: u32,
    pub(crate) primitive: Primitive,
    pub(crate) picture: &'a Picture<'a>,
    /// Empty from one strip to the next.
    pub(crate) fragments: &'b mut Fragments,
    pub(crate) buffer: &'b mut TileBuffer,
}

impl FragmentWriter<'_, '_> {
    /// The id that its name stands for.
    pub(crate) fn real_id(&self) -> u64 {
        self.buffer.names.id(self.id)
    }

    /// Writes one fragment, if it passes its depth test.
    pub(crate) fn write<C: ScalarContext>(
        &mut self,
        context: &mut C,
        sample: Sample,
        depth: Interval,
    ) {
        self.write_key(context, sample, self.picture.keys.key(depth));
    }

    /// Writes one fragment with this depth key, if it passes its depth test.
    pub(crate) fn write_key<C: ScalarContext>(
        &mut self,
        context: &mut C,
        sample: Sample,
        key: f32,
    ) {
        let index = self.buffer.index(sample);
        let incoming = &mut Incoming { id: self.id, primitive: Some(self.primitive) };
        self.buffer.settle_depth(&mut context.scalar(), self.picture, index, incoming, key);
    }

    /// Writes all fragments of one strip of the primitive, sixteen samples of a row or of as many rows at a time.
    #[inline(always)]
    pub(crate) fn write_strip<C: Context>(&mut self, context: &mut C, strip: &FlatSetup) {
        let here = strip.region.intersection(self.buffer.region());
        let simd = context.simd();
        let FragmentWriter { picture, fragments, buffer, .. } = self;
        // If the loops are watched, every test is an event.
        if !C::WATCHED && thin::is_thin(strip, &here) {
            apart!(simd, thin::draw(context, strip, &here, (picture, fragments), buffer));
        } else {
            many_samples::draw_strip(context, strip, picture, buffer);
        }
    }

    /// Asks the judge whether the primitive covers a sample that rounding leaves open.
    pub(crate) fn judge_covers<C: ScalarContext>(
        &mut self,
        context: &mut C,
        sample: Sample,
    ) -> bool {
        let id = self.real_id();
        judge_covers(&mut context.scalar(), self.picture, sample, id, &self.primitive)
    }
}
