//! A comparison as one page of HTML: the pictures side by side, every value, and the differing pixels in groups.
//!
//! The page is one file. It loads nothing from anywhere, and it runs from a folder, without a server. Its script is
//! in `page/`: `data.js` reads the values, `views.js` draws the pictures, `page.js` obeys the reader.
//!
//! ```
//! use bothways_lab::diff::foreign::{Buffer, Content, compare};
//! use bothways_lab::diff::page::Page;
//!
//! let mine = Buffer::new([3, 1], 1, Content::Mask(vec![true, true, false].into()));
//! let yours = Buffer::new([3, 1], 1, Content::Ids(vec![Some(0), None, Some(4)]));
//! let comparison = compare(&mine, &yours)?;
//! let page = Page::new(["mine", "yours"], [&mine, &yours], &comparison)?;
//! let mut html = Vec::new();
//! page.write(&mut html)?;
//! assert!(String::from_utf8(html)?.contains("differ: 2 pixels of 3"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod arrays;
mod content;
mod data;
mod escape;
mod groups;
mod shown;
mod summary;
mod template;

pub use content::Page;
pub use groups::Group;
pub(crate) use {data::write_data_uri, escape::escaped, shown::shown};

use super::compare::BufferComparison;
use super::foreign::Buffer;
use std::io::{self, Write};

/// The most pixels of a page: browsers draw no larger pictures.
const MOST_PIXELS: u64 = 8192 * 8192;
/// The longest side of a page's pictures.
const LONGEST_SIDE: u32 = 16_384;

/// The pictures are too large for a browser.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{} x {} pixels are too many for a page, which shows up to {} pixels with sides up to {}; compare parts of the \
     files",
    .size[0], .size[1], MOST_PIXELS, LONGEST_SIDE
)]
pub struct TooLarge {
    /// Width and height in pixels.
    pub size: [u32; 2],
}

impl<'a> Page<'a> {
    /// The page of a comparison, with its classes as groups and its hints as findings.
    ///
    /// # Errors
    ///
    /// If the pictures have more than 2²⁶ pixels, or a side of more than 16,384.
    pub fn new(
        names: [&str; 2],
        buffers: [&'a Buffer<'a>; 2],
        comparison: &'a BufferComparison,
    ) -> Result<Page<'a>, TooLarge> {
        let size = comparison.size;
        let pixels: u64 = size.map(u64::from).iter().product();
        if pixels > MOST_PIXELS || size.iter().any(|&side| side > LONGEST_SIDE) {
            return Err(TooLarge { size });
        }
        Ok(Page {
            names: names.map(str::to_owned),
            buffers,
            comparison,
            verdict: summary::verdict(comparison),
            good: comparison.passes,
            groups: Group::of_classes(comparison),
            findings: comparison.hints.clone(),
            figures: summary::figures(comparison, buffers),
            why: None,
        })
    }

    /// Writes the page: HTML in UTF-8.
    ///
    /// # Errors
    ///
    /// If writing fails.
    ///
    /// # Panics
    ///
    /// If a group names a pixel that does not exist.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        template::write(self, out)
    }
}

#[cfg(test)]
mod tests;
