//! Reads a mesh from an OBJ file on all threads of the current rayon pool: block after block, so that the file need not fit
//! into memory, and each block in pieces.
//!
//! The definitions and lines of all pieces of a block are counted first. Their sums tell each piece how many definitions and
//! lines precede it. So its parser counts back from where the parser of the whole file would, and names the same lines;
//! the first piece with an error has the first error of the file. While a block is parsed, the one before it is added to
//! the mesh, and the next one is read.

use super::builder::{MeshBuilder, Piece};
use super::error::StatementFault;
use super::parser::Parser;
use super::pieces::{Counts, cut, whole_statements};
use super::statements::{MOST_BYTES_A_STATEMENT, Statements, check_length};
use crate::source::BYTE_ORDER_MARK;
use rayon::prelude::*;
use std::io::{self, Read};

/// How much is read and parsed at once, in bytes. The mesh does not depend on it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sizes {
    /// What is read at once, more than a byte order mark; a statement may be longer.
    pub(super) block: usize,
    /// What one thread parses in one go.
    pub(super) piece: usize,
}

impl Sizes {
    /// The sizes for the threads of the current pool: a few pieces for each, and at most 64 MiB.
    pub(super) fn for_threads() -> Sizes {
        let piece = 1 << 19;
        Sizes { block: (piece * 6 * rayon::current_num_threads()).min(1 << 26), piece }
    }
}

/// Why a file was not read to its end.
#[derive(Debug)]
pub(super) enum Stopped {
    /// The system reports an error.
    Io(io::Error),
    /// A statement is wrong; it begins on this line.
    Statement(usize, StatementFault),
    /// The file is longer than it may be.
    TooLarge,
}

/// Parses all statements of a file, which has at most `most` bytes.
pub(super) fn read(
    input: impl Read + Send,
    most: u64,
    sizes: Sizes,
) -> Result<Parser<MeshBuilder>, Stopped> {
    let mut whole = Parser::new(MeshBuilder::default(), None);
    let mut blocks = Blocks { input, begun: Vec::new(), is_first: true, left: most };
    let mut before = Counts { lines: 1, ..Counts::default() };
    let (mut block, mut parsed) = (blocks.next(sizes.block), Vec::new());
    loop {
        let Block { statements, then } = block;
        let goes_on = matches!(then, Then::More);
        let (next, pieces) = rayon::join(
            || {
                append(&mut whole, parsed);
                goes_on.then(|| blocks.next(sizes.block))
            },
            || parse(&statements, &mut before, sizes.piece),
        );
        parsed = pieces?;
        block = match (next, then) {
            (Some(next), _) => next,
            (None, Then::Fail(error)) => return Err(error),
            (None, _) => break,
        };
    }
    append(&mut whole, parsed);
    Ok(whole)
}

fn append(whole: &mut Parser<MeshBuilder>, pieces: Vec<Parser<Piece>>) {
    for mut piece in pieces {
        whole.visitor.append(std::mem::take(&mut piece.visitor));
        whole.follow(piece);
    }
}

/// Parses a block. `before` are the lines and definitions before it, and then before the next block.
fn parse(block: &[u8], before: &mut Counts, size: usize) -> Result<Vec<Parser<Piece>>, Stopped> {
    let pieces = cut(block, size);
    let counts: Vec<Counts> = pieces.par_iter().map(|piece| Counts::of(piece)).collect();
    let starts: Vec<Counts> =
        counts.into_iter().map(|counts| std::mem::replace(before, before.and(counts))).collect();
    let parsed: Vec<_> = pieces
        .into_par_iter()
        .zip(starts)
        .map(|(piece, start)| parse_piece(piece, start))
        .collect();
    // The first error of all, not the first that a thread finds.
    parsed.into_iter().collect()
}

/// Parses a piece behind so many lines and definitions.
fn parse_piece(piece: &[u8], before: Counts) -> Result<Parser<Piece>, Stopped> {
    let mut parser = Parser::behind(Piece::default(), before.defined);
    let mut statements = Statements::from_line(piece, before.lines);
    loop {
        let (rest, line) = statements.rest();
        let quick = parser.quick_line(line, rest);
        if let Some(bytes) = quick.map_err(|fault| Stopped::Statement(line, fault))? {
            statements.skip_line(bytes);
            continue;
        }
        let Some((line, words)) = statements.next() else { return Ok(parser) };
        check_length(&words)
            .and_then(|()| parser.statement(line, words))
            .map_err(|fault| Stopped::Statement(line, fault))?;
    }
}

/// A part of a file.
struct Block {
    /// Whole statements; or the beginning of one that is too long.
    statements: Vec<u8>,
    then: Then,
}

/// What follows a block.
enum Then {
    More,
    End,
    Fail(Stopped),
}

/// Reads blocks of whole statements.
struct Blocks<R> {
    input: R,
    /// What has been read of the next block already.
    begun: Vec<u8>,
    is_first: bool,
    /// How many more bytes the file may have.
    left: u64,
}

impl<R: Read> Blocks<R> {
    /// Reads about `size` bytes.
    fn next(&mut self, size: usize) -> Block {
        let mut statements = std::mem::take(&mut self.begun);
        loop {
            let then = self.fill(&mut statements, size);
            if !matches!(then, Then::More) {
                return Block { statements, then };
            }
            let whole = whole_statements(&statements);
            if whole > 0 || statements.len() > MOST_BYTES_A_STATEMENT {
                // A statement that is too long makes the parser stop here.
                let whole = if whole == 0 { statements.len() } else { whole };
                self.begun = statements.split_off(whole);
                return Block { statements, then };
            }
        }
    }

    /// Reads up to `size` more bytes.
    fn fill(&mut self, bytes: &mut Vec<u8>, size: usize) -> Then {
        bytes.reserve(size);
        let read = self.input.by_ref().take(size as u64).read_to_end(bytes);
        if std::mem::take(&mut self.is_first) && bytes.starts_with(BYTE_ORDER_MARK) {
            bytes.drain(..BYTE_ORDER_MARK.len());
        }
        match read {
            Err(error) => {
                // What was read before the error still counts, up to the last whole statement.
                bytes.truncate(whole_statements(bytes));
                Then::Fail(Stopped::Io(error))
            }
            Ok(read) => match self.left.checked_sub(read as u64) {
                None => Then::Fail(Stopped::TooLarge),
                Some(_) if read < size => Then::End,
                Some(left) => {
                    self.left = left;
                    Then::More
                }
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Mesh, finish, parse as parse_in_order, stopped};
    use super::*;
    use proptest::collection::vec;
    use proptest::prelude::*;
    use proptest::sample::select;

    /// What the reader says about a file that it reads in blocks and pieces of these sizes: the mesh, or the message.
    fn in_parallel(bytes: &[u8], sizes: Sizes) -> Result<Mesh, String> {
        let read = read(bytes, u64::MAX, sizes);
        let mesh = match read {
            Ok(parser) => finish("a".to_owned(), parser),
            Err(error) => Err(stopped("a".to_owned(), error)),
        };
        mesh.map_err(|error| error.to_string())
    }

    fn in_order(bytes: &[u8]) -> Result<Mesh, String> {
        parse_in_order("a", bytes).map_err(|error| error.to_string())
    }

    /// Compared as text, because 0 equals −0.
    fn assert_alike(bytes: &[u8], sizes: Sizes) {
        let [expected, found] =
            [in_order(bytes), in_parallel(bytes, sizes)].map(|read| format!("{read:?}"));
        assert_eq!(found, expected, "{sizes:?}: {}", String::from_utf8_lossy(bytes));
    }

    /// Lines of files, some wrong, and pieces that make lines out of one another.
    #[expect(clippy::too_many_lines, reason = "it is a table of lines")]
    fn lines() -> impl Strategy<Value = Vec<u8>> {
        let right: &[&[u8]] = &[
            b"v 0 0 0\n",
            b"v 1 -2.5 1e-3\n",
            b"v 1 2 3 1\r\n",
            b"v\t1 2\t3 0.5 0.5 0.5 \n",
            b"  v 1 1 1\n",
            b"v 0.1 123456789012345678901 16777217\n",
            b"vt 0.5\n",
            b"vt 1 0\n",
            b"vt 1 0 7\r\n",
            b"vn 0 0 1\n",
            b"vn -0 .5 5.\n",
            b"vp 1 2\n",
            b"f 1 2 3\n",
            b"f -1 -2 -3\n",
            b"f 1 2 3 4\r\n",
            b"f 1/1 2/2 3/1\n",
            b"f 1//1 2//1 3//-1\n",
            b"f 1/1/1 2/-1/1 3/2/1\n",
            b"f 1/ 2// 3/1/\n",
            b"fo 3 2 1\n",
            b"f 1 2 3 1 2 3\n",
            b"f 1 2 -1 3 -2\n",
            b"f 1/1/1 -1/2 -2 2//1 4\n",
            b"usemtl a\n",
            b"usemtl b c\n",
            b"usemtl\n",
            b"mtllib a.mtl\n",
            b"o x\n",
            b"# a comment \\\n",
            b"\n",
            b"\r\n",
            b" \n",
            b"v 1 \\\n 2 3\n",
            b"f 1 \\\r\n2 \\\n3\n",
            b"\\\nv 1 1 1\n",
            b"v\\\n 1 1 1\n",
            b"g a\\b\n",
        ];
        let wrong: &[&[u8]] = &[
            b"v 1 2\n",
            b"v 1 2 nan\n",
            b"v 1e39 0 0\n",
            b"v 1 2 x\n",
            b"f 1 2\n",
            b"f 0 1 2\n",
            b"f 1 2 99\n",
            b"f 1 2 3x\n",
            b"f 1/1/1/1 2 3\n",
            b"f -99 1 2\n",
            b"f 1 2 +3\n",
            b"f 1 2 30000000000\n",
            b"x\n",
            b"\xff\n",
            b"f 1/9 2 3\n",
            b"f 1//9 2/9 3\n",
            b"v",
            b"f",
            b" 1",
            b"\\",
            b"\\\n",
            b"#",
            b"v 1 2 3",
            b"f 1 2 3",
            b"f 1//2 3 1",
        ];
        let (right, wrong) = (select(right.to_vec()), select(wrong.to_vec()));
        vec(prop_oneof![40 => right, 1 => wrong], 0..60).prop_map(|lines| lines.concat())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]
        #[test]
        fn pieces_of_any_size_give_what_the_reader_in_order_gives(
            lines in lines(),
            mark in any::<bool>(),
            block in 4_usize..300,
            piece in 1_usize..100,
        ) {
            let mark = if mark { BYTE_ORDER_MARK } else { b"" };
            let start = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0\nvt 1\nvn 1 0 0\n";
            assert_alike(&[mark, start, &lines].concat(), Sizes { block, piece });
            prop_assume!(!lines.is_empty());
            assert_alike(&[mark, &lines].concat(), Sizes { block, piece });
        }
    }

    #[test]
    fn a_file_of_many_blocks_is_read_as_the_reader_in_order_reads_it() {
        let mut bytes = Vec::new();
        let mesh = crate::generate::Kind::Torus.mesh([60, 40]).unwrap();
        super::super::write(&mesh, &mut bytes).unwrap();
        for sizes in
            [Sizes { block: 1 << 10, piece: 100 }, Sizes { block: 1 << 14, piece: 1 << 12 }]
        {
            assert_alike(&bytes, sizes);
            assert_eq!(in_parallel(&bytes, sizes), Ok(mesh.clone()));
        }
        // The error of the first piece wins, and its line is that of the file.
        let text = String::from_utf8(bytes).unwrap().replacen("\nf ", "\nf 1 2 x\nf ", 900);
        assert_alike(text.as_bytes(), Sizes { block: 1 << 14, piece: 1 << 10 });
    }

    #[test]
    fn what_was_read_before_an_error_of_the_system_is_checked_first() {
        struct Failing<'a>(&'a [u8]);
        impl Read for Failing<'_> {
            fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
                if self.0.is_empty() { Err(io::Error::other("gone")) } else { self.0.read(buffer) }
            }
        }
        let sizes = Sizes { block: 10, piece: 4 };
        let stopped =
            |text: &'static str| read(Failing(text.as_bytes()), u64::MAX, sizes).err().unwrap();
        assert!(matches!(stopped("v 1 2 3\nv 1"), Stopped::Io(_)));
        assert!(matches!(stopped("v 1 2 3\nv 1\nv 1"), Stopped::Statement(2, _)));
    }

    #[test]
    fn files_without_end_stop() {
        let sizes = Sizes { block: 1 << 20, piece: 1 << 18 };
        let stopped = |byte, most| read(io::repeat(byte), most, sizes).err().unwrap();
        assert!(matches!(stopped(b'\n', 1 << 22), Stopped::TooLarge));
        let endless = StatementFault::TooLong { most: MOST_BYTES_A_STATEMENT };
        assert!(
            matches!(stopped(b'f', u64::MAX), Stopped::Statement(1, fault) if fault == endless)
        );
        assert!(matches!(stopped(0, u64::MAX), Stopped::Statement(1, StatementFault::NotText)));
    }
}
