//! Finds the segments that pass through pixels: all pixels are processed in one strip before they descend into its
//! groups and halves.

use std::cmp::Ordering;

use super::super::lattice::{Coord, Point, Segment};
use super::{Group, Strip, Strips, partition_near};

/// A pixel during the descent.
#[derive(Debug, Clone, Copy, Default)]
struct Pixel<C> {
    at: Point<C>,
    name: u32,
    /// True if it went into two groups, so that its hits may be found twice.
    twice: bool,
}

/// Buffers of the search for pixels.
struct Finder<'a, C, F> {
    strips: &'a Strips<C>,
    segments: &'a [Segment<C>],
    /// Pixels of the strips being processed; those of a part follow those of the whole.
    open: Vec<Pixel<C>>,
    /// First and last group of each pixel in a strip.
    groups: Vec<(u32, u32)>,
    /// Starts of each group's open pixels; those of a part follow those of the whole.
    starts: Vec<usize>,
    /// Pairs that may have been found twice.
    twice: Vec<(u32, u32)>,
    found: F,
}

impl<C: Coord> Strips<C> {
    /// Calls `f` with each segment that passes through a pixel and the pixel's name, once for each.
    pub fn hits(
        &self,
        segments: &[Segment<C>],
        pixels: &[(Point<C>, u32)],
        f: impl FnMut(usize, u32),
    ) {
        let pixel = |&(at, name): &(Point<C>, u32)| Pixel { at, name, twice: false };
        let mut finder = Finder {
            strips: self,
            segments,
            open: pixels.iter().map(pixel).collect(),
            groups: Vec::new(),
            starts: Vec::new(),
            twice: Vec::new(),
            found: f,
        };
        finder.strip(0, 0);
        finder.twice.sort_unstable();
        finder.twice.dedup();
        let Finder { twice, mut found, .. } = finder;
        twice.iter().for_each(|&(i, name)| found(i as usize, name));
    }
}

impl<C: Coord, F: FnMut(usize, u32)> Finder<'_, C, F> {
    /// Searches for the open pixels from `start` on in one strip, then in its groups. Neighbours mostly follow one
    /// another, so that each search begins where the one before ended.
    fn strip(&mut self, index: u32, start: usize) {
        let Strip { stairs, groups } = self.strips.strips[index as usize];
        self.stairs(stairs, groups, start);
        if groups.1 - groups.0 == 1 {
            return self.group(groups.0, start);
        }
        let end = self.open.len();
        self.divide((groups.1 - groups.0) as usize, start);
        for group in (groups.0..groups.1).rev() {
            let start = self.starts.pop().unwrap_or(end);
            self.group(group, start);
            self.open.truncate(start);
        }
    }

    /// Lists the pixels of each group behind the open ones, group by group.
    fn divide(&mut self, groups: usize, start: usize) {
        let (end, base) = (self.open.len(), self.starts.len());
        self.starts.resize(base + groups, 0);
        let starts = &mut self.starts[base..];
        for &(first, last) in &self.groups {
            starts[first as usize..=last as usize].iter_mut().for_each(|count| *count += 1);
        }
        let mut place = end;
        for start in starts.iter_mut() {
            place += *start;
            *start = place;
        }
        self.open.resize(place, Pixel::default());
        // From the end of each list, so that afterwards its start is at hand.
        for (k, &(first, last)) in (start..end).zip(&self.groups).rev() {
            for start in &mut starts[first as usize..=last as usize] {
                *start -= 1;
                self.open[*start] = self.open[k];
            }
        }
    }

    /// Searches for the open pixels from `start` on in a group.
    fn group(&mut self, index: u32, start: usize) {
        let end = self.open.len();
        let Group { middle, halves, rest, .. } = self.strips.groups[index as usize];
        let Some((lower, upper)) = halves else {
            for k in start..end {
                for &i in &self.strips.lists[rest.0 as usize..rest.1 as usize] {
                    if self.segments[i as usize].hits_pixel(self.open[k].at) {
                        self.report(i, k);
                    }
                }
            }
            return;
        };
        for (half, is_lower) in [(lower, true), (upper, false)] {
            for k in start..end {
                let pixel = self.open[k];
                if (pixel.at.x < middle) == is_lower {
                    self.open.push(pixel);
                }
            }
            if self.open.len() > end {
                self.strip(half, end);
                self.open.truncate(end);
            }
        }
    }

    /// Finds the stairs that pass through pixels, and the groups that the pixels are in.
    fn stairs(&mut self, stairs: (u32, u32), groups: (u32, u32), start: usize) {
        let stairs = &self.strips.lists[stairs.0 as usize..stairs.1 as usize];
        let groups = &self.strips.groups[groups.0 as usize..groups.1 as usize];
        let (mut below, mut first) = (0, 0);
        self.groups.clear();
        for k in start..self.open.len() {
            let Pixel { at, .. } = self.open[k];
            let side = |i: &u32| self.segments[*i as usize].side_of_pixel(at);
            below = partition_near(stairs, below, |i| side(i) == Ordering::Greater);
            let mut above = below;
            while above < stairs.len() && side(&stairs[above]) == Ordering::Equal {
                // A stair's line hits; it counts only within the y range of the segment itself.
                if self.segments[stairs[above] as usize].hits_pixel(at) {
                    self.report(stairs[above], k);
                }
                above += 1;
            }
            if groups.len() > 1 {
                first = partition_near(groups, first, |group| group.end as usize <= below);
                let count = groups[first..].iter().position(|group| above < group.end as usize);
                let last = first + count.unwrap_or(0);
                self.groups.push((first as u32, last as u32));
                self.open[k].twice |= last > first;
            }
        }
    }

    fn report(&mut self, segment: u32, pixel: usize) {
        let Pixel { name, twice, .. } = self.open[pixel];
        if twice {
            self.twice.push((segment, name));
        } else {
            (self.found)(segment as usize, name);
        }
    }
}
