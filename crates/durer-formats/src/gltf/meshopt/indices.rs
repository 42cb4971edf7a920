//! Modes 1 and 2: the indices of triangle lists, and indices of any kind.

use super::{Bytes, Refusal, TOO_LONG, TOO_SHORT, unzigzag};

/// Entries of each queue.
const QUEUE: usize = 16;

/// The last sixteen values pushed; reading an entry that was never pushed is an error.
struct Queue<T> {
    entries: [Option<T>; QUEUE],
    pushed: usize,
}

impl<T: Copy> Queue<T> {
    fn new() -> Self {
        Self { entries: [None; QUEUE], pushed: 0 }
    }

    fn push(&mut self, entry: T) {
        self.entries[self.pushed % QUEUE] = Some(entry);
        self.pushed = self.pushed.wrapping_add(1);
    }

    /// Returns the entry pushed `age` before the last one.
    fn get(&self, age: u8) -> Result<T, Refusal> {
        let at = self.pushed.wrapping_sub(1 + usize::from(age)) % QUEUE;
        self.entries[at].ok_or("an edge or vertex that was never stored")
    }
}

/// State of the decoder of triangles.
struct Triangles<'a> {
    data: Bytes<'a>,
    edges: Queue<(u32, u32)>,
    vertices: Queue<u32>,
    /// The next index that was not used before.
    next: u32,
    /// The last index that was written out.
    last: u32,
}

/// Decodes triangle lists of `count` indices.
pub fn decode_triangles(data: &[u8], count: usize) -> Result<Vec<u32>, Refusal> {
    let mut input = Bytes(data);
    if input.byte()? != 0xe1 {
        return Err("the data do not begin with the mark of triangles");
    }
    let codes = input.take(count / 3)?;
    let tail = input.0.len().checked_sub(QUEUE).ok_or(TOO_SHORT)?;
    let (body, table) = input.0.split_at(tail);
    let mut state = Triangles {
        data: Bytes(body),
        edges: Queue::new(),
        vertices: Queue::new(),
        next: 0,
        last: 0,
    };
    let mut indices = Vec::with_capacity(count);
    for &code in codes {
        indices.extend(match code {
            0x00..0xf0 => state.on_edge(code)?,
            0xf0..0xfe => state.of_vertices(0, table[usize::from(code & 15)])?,
            0xfe.. => {
                let pair = state.data.byte()?;
                if pair == 0 {
                    state.next = 0;
                }
                state.of_vertices(if code == 0xfe { 0 } else { 15 }, pair)?
            }
        });
    }
    if state.data.0.is_empty() { Ok(indices) } else { Err(TOO_LONG) }
}

impl Triangles<'_> {
    fn fresh(&mut self) -> u32 {
        let index = self.next;
        self.next = index.wrapping_add(1);
        index
    }

    fn written(&mut self) -> Result<u32, Refusal> {
        self.last = self.last.wrapping_add(unzigzag(self.data.varint()?));
        Ok(self.last)
    }

    /// Decodes a triangle on an edge of the queue (high four bits), with a third vertex (low four).
    fn on_edge(&mut self, code: u8) -> Result<[u32; 3], Refusal> {
        let (a, b) = self.edges.get(code >> 4)?;
        let third = code & 15;
        let c = match third {
            0 => self.fresh(),
            1..13 => self.vertices.get(third)?,
            13 | 14 => {
                self.last = self.last.wrapping_add(if third == 13 { u32::MAX } else { 1 });
                self.last
            }
            _ => self.written()?,
        };
        if !(1..13).contains(&third) {
            self.vertices.push(c);
        }
        self.edges.push((c, b));
        self.edges.push((a, c));
        Ok([a, b, c])
    }

    /// Decodes a triangle of three vertices, each fresh (0), from the queue (1 … 14) or written out (15).
    fn of_vertices(&mut self, first: u8, pair: u8) -> Result<[u32; 3], Refusal> {
        let kinds = [first, pair >> 4, pair & 15];
        let mut triangle = [0; 3];
        // Fresh and stored ones first: none of the three is in the queue for the others yet.
        for (vertex, kind) in triangle.iter_mut().zip(kinds) {
            *vertex = match kind {
                0 => self.fresh(),
                1..15 => self.vertices.get(kind - 1)?,
                _ => self.written()?,
            };
        }
        for (vertex, kind) in triangle.into_iter().zip(kinds) {
            if kind == 0 || kind == 15 {
                self.vertices.push(vertex);
            }
        }
        let [a, b, c] = triangle;
        self.edges.push((b, a));
        self.edges.push((c, b));
        self.edges.push((a, c));
        Ok(triangle)
    }
}

/// Decodes indices of any kind, each against one of two baselines.
pub fn decode_sequence(data: &[u8], count: usize) -> Result<Vec<u32>, Refusal> {
    let mut input = Bytes(data);
    if input.byte()? != 0xd1 {
        return Err("the data do not begin with the mark of indices");
    }
    let tail = input.0.len().checked_sub(4).ok_or(TOO_SHORT)?;
    if count > tail {
        return Err(TOO_SHORT);
    }
    input.0 = &input.0[..tail];
    let mut baselines = [0u32; 2];
    let mut indices = Vec::with_capacity(count);
    for _ in 0..count {
        let v = input.varint()?;
        let baseline = &mut baselines[(v & 1) as usize];
        *baseline = baseline.wrapping_add(unzigzag(v >> 1));
        indices.push(*baseline);
    }
    if input.0.is_empty() { Ok(indices) } else { Err(TOO_LONG) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_triangles_on_an_edge() {
        // 0 1 2, all new, from the table's first entry; then its edge (0, 2) with a new vertex.
        let mut data = vec![0xe1, 0xf0, 0x00];
        data.extend([0; QUEUE]);
        assert_eq!(decode_triangles(&data, 6).unwrap(), [0, 1, 2, 0, 2, 3]);
        // The edge with the vertex after the last explicit one, 0 + 1; then an explicit one, +3.
        let mut data = vec![0xe1, 0xf0, 0x0e, 0x0f, 6];
        data.extend([0; QUEUE]);
        assert_eq!(decode_triangles(&data, 9).unwrap(), [0, 1, 2, 0, 2, 1, 0, 1, 4]);
        assert!(decode_triangles(&data[..data.len() - 1], 9).is_err());
        // An edge from an empty queue.
        let mut data = vec![0xe1, 0x00];
        data.extend([0; QUEUE]);
        assert!(decode_triangles(&data, 3).is_err());
    }

    #[test]
    fn sequences_have_two_baselines() {
        // +5 on the first, +100 on the second, −1 on the first, +1 on the second.
        let varints = [5 << 2, 100 << 2 | 1, 2, 1 << 2 | 1];
        let mut data = vec![0xd1];
        for v in varints {
            if v < 128 {
                data.push(v as u8);
            } else {
                data.extend([v as u8 | 0x80, (v >> 7) as u8]);
            }
        }
        data.extend([0; 4]);
        assert_eq!(decode_sequence(&data, 4).unwrap(), [5, 100, 4, 101]);
        assert!(decode_sequence(&data, 5).is_err());
        assert!(decode_sequence(&data, 3).is_err());
        assert!(decode_sequence(&data, 1_000_000_000).is_err());
    }
}
