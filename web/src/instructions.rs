//! Checks the instructions of a module.
//!
//! A vector instruction is the byte 0xFD and a number. The numbers from 0x100 on are the relaxed ones, some of which fuse
//! a multiplication and an addition on some machines: their results are not the same everywhere. (WebAssembly
//! specification, release 3.0, binary format of instructions.)

use crate::failure::Failure;
use wasmparser::{BinaryReader, Parser, Payload};

const VECTOR: u8 = 0xfd;
const FIRST_RELAXED: u32 = 0x100;

/// Makes sure that a module has vector instructions, and none of the relaxed ones; returns how many it has.
pub(crate) fn check(wasm: &[u8]) -> Result<u64, Failure> {
    let [vectors, relaxed] = count(wasm)?;
    match (vectors, relaxed) {
        (_, 1..) => Err(Failure::Relaxed { count: relaxed }),
        (0, 0) => Err(Failure::NoVectors),
        _ => Ok(vectors),
    }
}

/// The number of vector instructions, and that of relaxed ones.
fn count(wasm: &[u8]) -> Result<[u64; 2], wasmparser::BinaryReaderError> {
    let mut counts = [0; 2];
    for payload in Parser::new(0).parse_all(wasm) {
        let Payload::CodeSectionEntry(body) = payload? else { continue };
        let mut operators = body.get_operators_reader()?;
        while !operators.eof() {
            let at = operators.original_position();
            operators.read()?;
            if wasm.get(at) == Some(&VECTOR) {
                let number = BinaryReader::new(&wasm[at + 1..], at + 1).read_var_u32()?;
                counts[usize::from(number >= FIRST_RELAXED)] += 1;
            }
        }
    }
    Ok(counts)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A module with one function that takes and returns nothing, and has these instructions.
    fn module(instructions: &[u8]) -> Vec<u8> {
        let body = [&[0], instructions, &[0x0b]].concat();
        let length = |bytes: &[u8]| u8::try_from(bytes.len()).unwrap();
        let code = [&[1, length(&body)], &body[..]].concat();
        let types_and_functions = [1, 4, 1, 0x60, 0, 0, 3, 2, 1, 0];
        [b"\0asm\x01\0\0\0", &types_and_functions[..], &[10, length(&code)], &code].concat()
    }

    /// `v128.const 0`, an instruction on it (a number of one or two bytes), `drop`.
    fn with(number: &[u8]) -> Vec<u8> {
        let constant = [&[VECTOR, 12], &[0; 16][..]].concat();
        module(&[&constant[..], &constant, &[VECTOR], number, &[0x1a]].concat())
    }

    #[test]
    fn vectors_are_counted() {
        // f32x4.add
        assert_eq!(check(&with(&[0xe4, 0x01])).unwrap(), 3);
    }

    #[test]
    fn a_relaxed_instruction_is_refused() {
        // i8x16.relaxed_swizzle
        let says = check(&with(&[0x80, 0x02])).unwrap_err().to_string();
        assert!(says.starts_with("the module has 1 relaxed vector instructions"), "{says}");
    }

    #[test]
    fn a_module_without_vectors_is_refused() {
        // i32.const 0xfd, drop: that byte alone is no vector instruction.
        assert!(matches!(check(&module(&[0x41, 0xfd, 0x01, 0x1a])), Err(Failure::NoVectors)));
        assert!(matches!(check(b"no module"), Err(Failure::Unreadable(_))));
    }
}
