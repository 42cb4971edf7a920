//! State of an algorithm as a table whose cells know whether they changed.

use super::words::{Value, Word};

/// The data that an algorithm works with, after a step.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Table {
    /// Heads of the columns, the first one above the names of the rows; empty for a table without heads.
    pub heads: Vec<Word>,
    /// Rows from top to bottom.
    pub rows: Vec<Row>,
}

/// A row of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Name of the row, by which the row of the step before is found.
    pub name: Value,
    /// Cells from left to right, as many as there are.
    pub cells: Vec<TableCell>,
}

/// A cell of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct TableCell {
    /// Value that it shows.
    pub value: Value,
    /// True if the step before showed another value here, or none.
    pub changed: bool,
}

impl Table {
    /// Creates a table without rows.
    pub(crate) fn new<const N: usize>(heads: [Word; N]) -> Self {
        Self { heads: heads.into(), rows: Vec::new() }
    }

    /// Adds a row at the bottom.
    pub(crate) fn row(&mut self, name: impl Into<Value>, cells: impl IntoIterator<Item = Value>) {
        let cells = cells.into_iter().map(|value| TableCell { value, changed: false }).collect();
        self.rows.push(Row { name: name.into(), cells });
    }

    /// Marks the cells that differ from those of the step before.
    pub(super) fn mark_changes(&mut self, before: Option<&Self>) {
        let Some(before) = before else { return };
        for (i, row) in self.rows.iter_mut().enumerate() {
            // Mostly a row is where it was.
            let same = |r: &&Row| r.name == row.name;
            let old = before.rows.get(i).filter(same).or_else(|| before.rows.iter().find(same));
            for (k, cell) in row.cells.iter_mut().enumerate() {
                let value = old.and_then(|old| old.cells.get(k)).map(|cell| &cell.value);
                cell.changed = value != Some(&cell.value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_know_that_they_changed() {
        let table = |rows: &[(&str, f64)]| {
            let mut table = Table::default();
            rows.iter().for_each(|&(name, x)| table.row(name, [x.into()]));
            table
        };
        let before = table(&[("a", 1.0), ("b", 2.0)]);
        let mut after = table(&[("b", 2.0), ("c", 3.0), ("a", 4.0)]);
        after.mark_changes(None);
        assert!(after.rows.iter().all(|row| !row.cells[0].changed));
        after.mark_changes(Some(&before));
        let changed: Vec<bool> = after.rows.iter().map(|row| row.cells[0].changed).collect();
        assert_eq!(changed, [false, true, true]);
    }
}
