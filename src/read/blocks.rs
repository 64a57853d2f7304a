//! A stream cut into blocks of whole lines, hashed on the way.

use std::io::{self, Read};

/// How much is read at a time.
const BLOCK: usize = 2 << 20;

/// Some whole lines of an input.
pub(super) struct Block {
    /// The lines with their ends; the last line of the input may lack one.
    pub(super) text: Vec<u8>,
    /// The number of the first line, from 1.
    pub(super) line: usize,
}

/// The blocks of an input, in order.
pub(super) struct Blocks<R> {
    input: R,
    /// The beginning of a line whose end has not been read yet.
    rest: Vec<u8>,
    /// Room that blocks were in: new pages cost as much as filling them.
    spare: Vec<Vec<u8>>,
    line: usize,
    done: bool,
    pub(super) hasher: blake3::Hasher,
    pub(super) bytes: u64,
}

impl<R: Read> Blocks<R> {
    pub(super) fn new(input: R) -> Self {
        Blocks {
            input,
            rest: Vec::new(),
            spare: Vec::new(),
            line: 1,
            done: false,
            hasher: blake3::Hasher::new(),
            bytes: 0,
        }
    }

    /// The next lines, or nothing after the last.
    pub(super) fn next(&mut self) -> io::Result<Option<Block>> {
        let mut text = self.spare.pop().unwrap_or_default();
        text.clear();
        text.append(&mut self.rest);
        while !self.done {
            let known = text.len();
            self.fill(&mut text)?;
            if self.done {
                break;
            }
            if let Some(newline) = memchr::memrchr(b'\n', &text[known..]) {
                self.rest.extend_from_slice(&text[known + newline + 1..]);
                text.truncate(known + newline + 1);
                break;
            }
        }
        if text.is_empty() {
            return Ok(None);
        }
        let line = self.line;
        self.line += memchr::memchr_iter(b'\n', &text).count();
        Ok(Some(Block { text, line }))
    }

    /// Takes the room of a block that is done with.
    pub(super) fn reuse(&mut self, text: Vec<u8>) {
        self.spare.push(text);
    }

    /// Appends the next [`BLOCK`] bytes to `text`, or what is left.
    fn fill(&mut self, text: &mut Vec<u8>) -> io::Result<()> {
        let known = text.len();
        text.reserve(BLOCK);
        let read = self.input.by_ref().take(BLOCK as u64).read_to_end(text)?;
        self.done = read < BLOCK;
        self.hasher.update(&text[known..]);
        self.bytes += read as u64;
        Ok(())
    }
}

/// The lines of a text with the byte at which each begins; line ends are left off.
pub(super) fn lines(text: &[u8]) -> impl Iterator<Item = (usize, &[u8])> {
    let mut from = 0;
    std::iter::from_fn(move || {
        if from >= text.len() {
            return None;
        }
        let start = from;
        let end = memchr::memchr(b'\n', &text[start..]).map_or(text.len(), |n| start + n);
        from = end + 1;
        let line = &text[start..end];
        Some((start, line.strip_suffix(b"\r").unwrap_or(line)))
    })
}

/// The last line of a block without white space at its end, and its number.
pub(super) fn last_line(text: &[u8], first_line: usize) -> (usize, Vec<u8>) {
    let count = memchr::memchr_iter(b'\n', text).count();
    let ended = text.ends_with(b"\n");
    let from = memchr::memrchr(b'\n', &text[..text.len() - usize::from(ended)]).map_or(0, |n| n + 1);
    (first_line + count - usize::from(ended), text[from..].trim_ascii_end().to_vec())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gives a few bytes at a time, as a pipe may.
    struct Drip<'a>(&'a [u8]);

    impl Read for Drip<'_> {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            let n = buffer.len().min(self.0.len()).min(7);
            buffer[..n].copy_from_slice(&self.0[..n]);
            self.0 = &self.0[n..];
            Ok(n)
        }
    }

    #[test]
    fn blocks_hold_whole_lines_and_lose_nothing() {
        let line = b"0.25 1 2 3 4\r\n".as_slice();
        let text = line.repeat(2 * BLOCK / line.len() + 3);
        let text = &text[..text.len() - 2];
        let mut blocks = Blocks::new(Drip(text));
        let (mut joined, mut count) = (Vec::<u8>::new(), 0);
        while let Some(block) = blocks.next().unwrap() {
            assert_eq!(block.line, joined.len() / line.len() + 1);
            joined.extend(&block.text);
            count += 1;
        }
        assert!(joined == text && count == 3);
        assert_eq!(blocks.bytes, text.len() as u64);
        assert_eq!(blocks.hasher.finalize(), blake3::hash(text));
    }

    #[test]
    fn lines_know_where_they_begin() {
        let found: Vec<_> = lines(b"a\r\n\nbc").collect();
        assert_eq!(found, [(0, b"a".as_slice()), (3, b""), (4, b"bc")]);
    }
}
