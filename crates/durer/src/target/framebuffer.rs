//! Planes of pixels: colour, depth, item, normal, stencil, colour index.

use crate::work::{Charge, Work};
use crate::{Error, Result};

/// Row of a picture that comes first in memory. In pictures of scenes it is the top row; [`crate::commands`] draw in
/// either order, and [`Framebuffer::with_origin`] converts one to the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum RowOrigin {
    /// Row 0 is the top row, as in PNG; y grows downwards.
    #[default]
    TopLeft,
    /// Row 0 is the bottom row, as in OpenGL; y grows upwards.
    BottomLeft,
}

/// A rectangle of pixel values in rows, without padding.
///
/// # Guarantees
/// `data.len() == width · height`.
#[derive(Debug, Clone, PartialEq)]
pub struct Pixels<T> {
    width: u32,
    height: u32,
    data: Vec<T>,
    /// Charge of the values to a budget.
    charge: Charge,
}

impl<T: Copy> Pixels<T> {
    /// Creates a plane filled with one value. Zero-size planes are allowed and empty.
    pub fn new(width: u32, height: u32, value: T) -> Self {
        let data = vec![value; width as usize * height as usize];
        Self { width, height, data, charge: Charge::default() }
    }

    /// Creates a plane filled with one value, whose memory is charged to a budget until it is dropped.
    ///
    /// # Errors
    /// [`Error::Memory`] if the budget has too little left, [`Error::OutOfMemory`] if the system has.
    pub fn within(
        (work, stage): (&Work, &'static str),
        width: u32,
        height: u32,
        value: T,
    ) -> Result<Self> {
        let count = u64::from(width) * u64::from(height);
        let charge = work.charge_for::<T>(stage, count)?;
        work.room_for::<T>(stage, count)?;
        Ok(Self { charge, ..Self::new(width, height, value) })
    }

    /// Returns the work that the plane was charged to; one without bounds if it was charged to none. Results derived
    /// from the plane can be charged to the same budget.
    pub fn work(&self) -> Work {
        self.charge.work()
    }

    /// Creates a plane from rows laid one after the other.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless `data.len() == width · height`.
    pub fn from_data(width: u32, height: u32, data: Vec<T>) -> Result<Self> {
        if data.len() as u64 == u64::from(width) * u64::from(height) {
            Ok(Self { width, height, data, charge: Charge::default() })
        } else {
            Err(Error::parameter("data length", data.len(), "width × height"))
        }
    }

    /// Charges a plane that was made without a budget to one, until it is dropped.
    ///
    /// # Errors
    /// [`Error::Memory`] if the budget has too little left.
    pub fn charged_to(mut self, work: &Work, stage: &'static str) -> Result<Self> {
        self.charge = work.charge_for::<T>(stage, self.data.len() as u64)?;
        Ok(self)
    }

    /// Returns the width in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Returns the height in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Returns the value at column x, row y; `None` outside.
    pub fn get(&self, x: u32, y: u32) -> Option<T> {
        (x < self.width && y < self.height)
            .then(|| self.data[y as usize * self.width as usize + x as usize])
    }

    /// Sets the value at column x, row y; outside the plane nothing happens.
    pub fn set(&mut self, x: u32, y: u32, value: T) {
        if x < self.width && y < self.height {
            self.data[y as usize * self.width as usize + x as usize] = value;
        }
    }

    /// Returns the row y, from left to right. Empty for a row that does not exist.
    pub fn row(&self, y: u32) -> &[T] {
        let start = (y as usize * self.width as usize).min(self.data.len());
        let end = (start + self.width as usize).min(self.data.len());
        &self.data[start..end]
    }

    /// Returns the row y, to write to.
    pub fn row_mut(&mut self, y: u32) -> &mut [T] {
        let start = (y as usize * self.width as usize).min(self.data.len());
        let end = (start + self.width as usize).min(self.data.len());
        &mut self.data[start..end]
    }

    /// Returns all values, row after row.
    pub fn data(&self) -> &[T] {
        &self.data
    }

    /// Returns all values, to write to.
    pub fn data_mut(&mut self) -> &mut [T] {
        &mut self.data
    }

    /// Returns all values, by value.
    pub fn into_data(self) -> Vec<T> {
        self.data
    }

    /// Turns the order of the rows over.
    pub(crate) fn reverse_rows(&mut self) {
        let width = (self.width as usize).max(1);
        let rows = self.data.len() / width;
        for y in 0..rows / 2 {
            let (above, below) = self.data.split_at_mut((rows - 1 - y) * width);
            above[y * width..(y + 1) * width].swap_with_slice(&mut below[..width]);
        }
    }

    /// Copies `source` with its first pixel at column x, row y; parts outside are dropped.
    pub fn paste(&mut self, source: &Self, x: u32, y: u32) {
        let columns = source.width.min(self.width.saturating_sub(x)) as usize;
        for row in 0..source.height.min(self.height.saturating_sub(y)) {
            self.row_mut(y + row)[x as usize..x as usize + columns]
                .copy_from_slice(&source.row(row)[..columns]);
        }
    }
}

/// The item of a pixel that nothing covers.
pub const NO_ITEM: u32 = u32::MAX;

/// The planes a picture is made in. Colour is always there; the others when requested.
#[derive(Debug, Clone, PartialEq)]
pub struct Framebuffer {
    /// Row that comes first. [`crate::commands`] draw in either order; [`crate::pipeline`] makes pictures with the top
    /// row first, which all writers expect.
    pub origin: RowOrigin,
    /// 8-bit sRGB with straight (not premultiplied) alpha.
    pub color: Pixels<[u8; 4]>,
    /// Window depth 0 (near) … 1 (far) at the pixel centre; 1 at the background.
    pub depth: Option<Pixels<f32>>,
    /// Index of the visible item at the pixel centre, [`NO_ITEM`] at the background.
    pub item: Option<Pixels<u32>>,
    /// Unit normal in world space at the pixel centre; zero at the background.
    pub normal: Option<Pixels<[f32; 3]>>,
    /// Stencil values.
    pub stencil: Option<Pixels<u8>>,
    /// Colour indices. With this plane fragments are drawn as indices, and the colour plane shows them
    /// once a palette ([`crate::fragment::Palette`]) has resolved them.
    pub index: Option<Pixels<u8>>,
}

/// Name of planes in errors about memory.
const PLANES: &str = "planes of the picture";

impl Framebuffer {
    /// Creates a framebuffer with a colour plane only, transparent black.
    pub fn new(width: u32, height: u32) -> Self {
        Self {
            origin: RowOrigin::TopLeft,
            color: Pixels::new(width, height, [0; 4]),
            depth: None,
            item: None,
            normal: None,
            stencil: None,
            index: None,
        }
    }

    /// Creates a framebuffer as [`Self::new`] makes it, within a budget.
    ///
    /// # Errors
    /// As [`Pixels::within`].
    pub fn within(work: &Work, width: u32, height: u32) -> Result<Self> {
        let color = Pixels::within((work, PLANES), width, height, [0; 4])?;
        Ok(Self { color, ..Self::new(0, 0) })
    }

    /// Adds the requested planes, cleared as new, within a budget.
    ///
    /// # Errors
    /// As [`Pixels::within`].
    pub fn add_planes(&mut self, work: &Work, depth: bool, item: bool, normal: bool) -> Result<()> {
        let (of, width, height) = ((work, PLANES), self.width(), self.height());
        if depth {
            self.depth = Some(Pixels::within(of, width, height, 1.0)?);
        }
        if item {
            self.item = Some(Pixels::within(of, width, height, NO_ITEM)?);
        }
        if normal {
            self.normal = Some(Pixels::within(of, width, height, [0.0; 3])?);
        }
        Ok(())
    }

    /// Returns the width in pixels.
    pub fn width(&self) -> u32 {
        self.color.width()
    }

    /// Returns the height in pixels.
    pub fn height(&self) -> u32 {
        self.color.height()
    }

    /// Turns over the rows of all planes unless the picture has this order; returns the picture.
    ///
    /// ```
    /// use durer::target::{Framebuffer, RowOrigin};
    ///
    /// let mut picture = Framebuffer { origin: RowOrigin::BottomLeft, ..Framebuffer::new(1, 2) };
    /// picture.color.set(0, 0, [9; 4]);
    /// let picture = picture.with_origin(RowOrigin::TopLeft);
    /// assert_eq!(picture.color.data(), [[0; 4], [9; 4]]);
    /// ```
    pub fn with_origin(mut self, origin: RowOrigin) -> Self {
        if self.origin != origin {
            self.origin = origin;
            self.color.reverse_rows();
            self.depth.iter_mut().for_each(Pixels::reverse_rows);
            self.item.iter_mut().for_each(Pixels::reverse_rows);
            self.normal.iter_mut().for_each(Pixels::reverse_rows);
            self.stencil.iter_mut().for_each(Pixels::reverse_rows);
            self.index.iter_mut().for_each(Pixels::reverse_rows);
        }
        self
    }

    /// Adds a depth plane cleared to 1, the far end.
    pub fn with_depth(mut self) -> Self {
        self.depth = Some(Pixels::new(self.width(), self.height(), 1.0));
        self
    }

    /// Adds an item plane cleared to [`NO_ITEM`].
    pub fn with_items(mut self) -> Self {
        self.item = Some(Pixels::new(self.width(), self.height(), NO_ITEM));
        self
    }

    /// Adds a normal plane cleared to zero.
    pub fn with_normals(mut self) -> Self {
        self.normal = Some(Pixels::new(self.width(), self.height(), [0.0; 3]));
        self
    }

    /// Adds a stencil plane cleared to zero.
    pub fn with_stencil(mut self) -> Self {
        self.stencil = Some(Pixels::new(self.width(), self.height(), 0));
        self
    }

    /// Adds a plane of colour indices cleared to zero: the framebuffer becomes a colour-index framebuffer.
    pub fn with_indices(mut self) -> Self {
        self.index = Some(Pixels::new(self.width(), self.height(), 0));
        self
    }
}
