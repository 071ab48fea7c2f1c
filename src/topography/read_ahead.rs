//! Blocks of a large file, read by another thread while their content is parsed.

use std::io::{self, BufRead, Read};
use std::mem::take;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::{Builder, scope};

/// Bytes of a block.
const BLOCK: usize = 1 << 22;

/// Blocks in memory: one being read, one being parsed, one between them.
const BLOCKS: usize = 3;

/// Bytes at the beginning of a buffer.
#[derive(Default)]
struct Block {
    bytes: Vec<u8>,
    filled: usize,
}

impl Block {
    /// Fills the block up to its end, or to that of the source.
    fn fill(&mut self, source: &mut impl Read) -> io::Result<()> {
        self.filled = 0;
        if self.bytes.is_empty() {
            self.bytes.try_reserve_exact(BLOCK)?;
            self.bytes.resize(BLOCK, 0);
        }
        while self.filled < BLOCK {
            match source.read(&mut self.bytes[self.filled..]) {
                Ok(0) => break,
                Ok(read) => self.filled += read,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }
}

/// Content of a source in blocks read by another thread.
pub(super) struct ReadAhead {
    blocks: Receiver<io::Result<Block>>,
    spent: Sender<Block>,
    block: Block,
    /// Number of parsed bytes of the block.
    taken: usize,
}

impl BufRead for ReadAhead {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.taken == self.block.filled {
            // The reader may have ended already.
            let _ = self.spent.send(take(&mut self.block));
            self.taken = 0;
            // Without a further block the source has ended.
            self.block = self.blocks.recv().unwrap_or_else(|_| Ok(Block::default()))?;
        }
        Ok(&self.block.bytes[self.taken..self.block.filled])
    }

    fn consume(&mut self, count: usize) {
        self.taken = (self.taken + count).min(self.block.filled);
    }
}

impl Read for ReadAhead {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.fill_buf()?.read(buffer)?;
        self.consume(read);
        Ok(read)
    }
}

/// Calls `parse` with the content of a source, read by another thread. Returns `None`, with nothing read, if the
/// system starts no thread.
pub(super) fn read_ahead<A>(
    source: &mut (impl Read + Send),
    parse: impl FnOnce(ReadAhead) -> A,
) -> Option<A> {
    let ((full, blocks), (spent, free)) = (channel(), channel());
    (0..BLOCKS).try_for_each(|_| spent.send(Block::default())).ok()?;
    let read = move || {
        // Both channels end with the parser.
        while let Ok(mut block) = free.recv() {
            let filled = block.fill(source).map(|()| block);
            let is_last = filled.as_ref().map_or(true, |block| block.filled < BLOCK);
            if full.send(filled).is_err() || is_last {
                return;
            }
        }
    };
    scope(|scope| {
        Builder::new().spawn_scoped(scope, read).ok()?;
        Some(parse(ReadAhead { blocks, spent, block: Block::default(), taken: 0 }))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Source of so many bytes, in pieces of odd lengths, ending with an error if it fails.
    struct Pieces {
        at: usize,
        count: usize,
        fails: bool,
    }

    impl Read for Pieces {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            let length = buffer.len().min(self.count - self.at).min(1 + self.at % 70_001);
            if length == 0 && self.fails {
                return Err(io::Error::other("a broken disk"));
            }
            buffer[..length].iter_mut().zip(self.at..).for_each(|(byte, index)| *byte = (index % 251) as u8);
            self.at += length;
            Ok(length)
        }
    }

    #[test]
    fn all_bytes_come_in_order_up_to_the_end_or_the_error() {
        for count in [0, 1, BLOCK - 1, BLOCK, BLOCK + 1, 5 * BLOCK + 77] {
            for fails in [false, true] {
                let mut source = Pieces { at: 0, count, fails };
                let mut bytes = Vec::new();
                let result = read_ahead(&mut source, |mut content| content.read_to_end(&mut bytes)).unwrap();
                assert_eq!(result.is_err(), fails, "{count}");
                // Before an error the interrupted block is missing.
                let expected = if fails { count - count % BLOCK } else { count };
                assert_eq!(bytes.len(), expected, "{fails}");
                assert!(bytes.iter().enumerate().all(|(index, byte)| *byte == (index % 251) as u8));
            }
        }
    }

    #[test]
    fn the_reader_ends_with_the_parser() {
        let mut source = Pieces { at: 0, count: 100 * BLOCK, fails: false };
        let first = read_ahead(&mut source, |mut content| content.fill_buf().map(|bytes| bytes[0]).unwrap());
        assert_eq!(first, Some(0));
        assert!(source.at <= (BLOCKS + 1) * BLOCK, "{}", source.at);
    }
}
