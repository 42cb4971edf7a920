//! A stream of map data that ends when the work is stopped.

use durer::work::Work;
use std::io::{self, BufRead, Read};

/// A source that ends with an error if its work is stopped, or if there is no memory left for the data held.
pub struct Watched {
    source: Box<dyn BufRead>,
    work: Work,
    /// True if all that is read stays.
    holds: bool,
}

impl Watched {
    /// Creates a source of a file that is held whole, or is not.
    pub fn new(source: Box<dyn BufRead>, work: &Work, holds: bool) -> Self {
        Self { source, work: work.part(), holds }
    }

    fn taken(&self, bytes: usize) -> io::Result<()> {
        let kept = if self.holds { bytes as u64 } else { 0 };
        self.work.keep("map data", kept).map_err(|e| io::Error::other(e.to_string()))
    }
}

impl Read for Watched {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let count = self.source.read(bytes)?;
        self.taken(count).map(|()| count)
    }
}

impl BufRead for Watched {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        self.taken(0)?;
        self.source.fill_buf()
    }

    fn consume(&mut self, count: usize) {
        self.source.consume(count);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer::Error;
    use std::io::Cursor;

    #[test]
    fn what_is_held_is_charged_and_a_stop_ends_it() {
        let source = || Box::new(Cursor::new(vec![0_u8; 100])) as Box<dyn BufRead>;
        let work = Work::with_budget(60, "--max-memory");
        let mut all = Vec::new();
        Watched::new(source(), &work, false).read_to_end(&mut all).unwrap();
        let error = Watched::new(source(), &work, true).read_to_end(&mut all).unwrap_err();
        assert!(error.to_string().starts_with("map data: "), "{error}");
        assert_eq!(work.used(), 0);
        work.stop(Error::Cancelled);
        let error = Watched::new(source(), &work, false).fill_buf().unwrap_err();
        assert_eq!(error.to_string(), Error::Cancelled.to_string());
    }
}
