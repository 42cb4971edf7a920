//! Tables in Markdown.

/// Prints a heading and the line below it.
pub fn head(cells: &[&str]) {
    row(&cells.iter().map(ToString::to_string).collect::<Vec<_>>());
    row(&vec!["---".to_owned(); cells.len()]);
}

/// Prints a row.
pub fn row(cells: &[String]) {
    println!("| {} |", cells.join(" | "));
}
