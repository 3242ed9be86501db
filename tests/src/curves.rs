//! Reads the CSV table that `mouthpiece curves` writes.

/// A table of numbers with named columns.
#[derive(Clone, Debug)]
pub struct Table {
    names: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Table {
    /// Reads CSV text with a line of names first.
    #[must_use]
    pub fn parse(csv: &str) -> Self {
        let mut lines = csv.lines();
        let names: Vec<String> = lines
            .next()
            .unwrap_or_default()
            .split(',')
            .map(str::to_owned)
            .collect();
        let rows: Vec<Vec<f64>> = lines
            .map(|line| line.split(',').map(|v| v.parse().expect(line)).collect())
            .collect();
        assert!(!rows.is_empty(), "a table without rows");
        assert!(rows.iter().all(|row| row.len() == names.len()));
        Self { names, rows }
    }

    /// All values of a column.
    #[must_use]
    pub fn column(&self, name: &str) -> Vec<f64> {
        let index = self
            .names
            .iter()
            .position(|n| n == name)
            .unwrap_or_else(|| panic!("no column {name} among {:?}", self.names));
        self.rows.iter().map(|row| row[index]).collect()
    }

    /// How many rows there are.
    #[must_use]
    pub fn row_count(&self) -> usize {
        self.rows.len()
    }

    /// The names of the columns, in order.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }
}
