//! Text set in columns.

/// Lines with their cells one below the other: the first `left` columns and the last are flush left, the others flush right.
pub fn columns(lines: &[Vec<String>], left: usize) -> String {
    let count = lines.iter().map(Vec::len).max().unwrap_or(0);
    let width = |i: usize| lines.iter().filter_map(|line| line.get(i)).map(|cell| cell.chars().count()).max();
    let widths: Vec<usize> = (0..count).map(|i| width(i).unwrap_or(0)).collect();
    let row = |line: &Vec<String>| {
        let cell = |(i, cell): (usize, &String)| match i {
            i if i < left || i + 1 == count => format!("{cell:<0$}", widths[i]),
            i => format!("{cell:>0$}", widths[i]),
        };
        let cells: Vec<String> = line.iter().enumerate().map(cell).collect();
        format!("{}\n", cells.join("  ").trim_end())
    };
    lines.iter().map(row).collect()
}
