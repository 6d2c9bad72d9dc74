//! One JSON object of a scene file, read field by field with errors that say where.

use crate::error::{FileError, SceneError};
use crate::suggest::nearest;
use serde_json::{Map, Value};

/// A JSON object, the file it is from and what it describes.
pub(crate) struct Fields<'a> {
    pub file: &'a str,
    pub place: String,
    map: &'a Map<String, Value>,
}

impl<'a> Fields<'a> {
    /// `value` as an object with only the `allowed` fields.
    pub fn of(file: &'a str, place: String, value: &'a Value, allowed: &[&str]) -> Result<Self, FileError> {
        let Value::Object(map) = value else {
            return Err(wrong_type(file, place, value, "an object: {...}"));
        };
        if let Some(field) = map.keys().find(|field| !allowed.contains(&field.as_str())) {
            return Err(FileError::UnknownField {
                file: file.to_owned(),
                place,
                field: field.clone(),
                nearest: nearest(field, allowed.iter().copied()),
                allowed: allowed.join(", "),
            });
        }
        Ok(Self { file, place, map })
    }

    /// The value of a field, if it is there.
    pub fn get(&self, field: &str) -> Option<&'a Value> {
        self.map.get(field)
    }

    pub fn required(&self, field: &str) -> Result<&'a Value, FileError> {
        self.get(field).ok_or_else(|| self.missing(&format!("\"{field}\"")))
    }

    pub fn missing(&self, field: &str) -> FileError {
        FileError::MissingField { file: self.file.to_owned(), place: self.place.clone(), field: field.to_owned() }
    }

    pub fn string(&self, field: &str) -> Result<Option<String>, FileError> {
        self.read(field, "a text in quotes", |value| value.as_str().map(str::to_owned))
    }

    pub fn flag(&self, field: &str) -> Result<Option<bool>, FileError> {
        self.read(field, "true or false", Value::as_bool)
    }

    pub fn number(&self, field: &str) -> Result<Option<f64>, FileError> {
        self.read(field, "a number", Value::as_f64)
    }

    /// N numbers.
    pub fn numbers<const N: usize>(&self, field: &str) -> Result<Option<[f64; N]>, FileError> {
        self.read(field, expected(N, false), as_numbers)
    }

    /// Three rows of three numbers.
    pub fn tensor(&self, field: &str) -> Result<Option<[[f64; 3]; 3]>, FileError> {
        self.read(field, "three rows of three numbers: [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]", |value| {
            let rows = value.as_array()?.iter().map(as_numbers).collect::<Option<Vec<[f64; 3]>>>()?;
            rows.try_into().ok()
        })
    }

    /// Points of N coordinates.
    pub fn points<const N: usize>(&self, field: &str) -> Result<Option<Vec<[f64; N]>>, FileError> {
        self.read(field, expected(N, true), |value| value.as_array()?.iter().map(as_numbers).collect())
    }

    /// Triples of numbers of vertices.
    pub fn indices(&self, field: &str) -> Result<Option<Vec<[u32; 3]>>, FileError> {
        let triple = |value: &Value| -> Option<[u32; 3]> {
            let number = |value: &Value| value.as_u64().and_then(|k| u32::try_from(k).ok());
            value.as_array()?.iter().map(number).collect::<Option<Vec<u32>>>()?.try_into().ok()
        };
        let expected = "a list of three numbers of vertices each: [[0, 1, 2], ...]";
        self.read(field, expected, |value| value.as_array()?.iter().map(triple).collect())
    }

    /// What a scene says against it, with the place in the file.
    pub fn invalid(&self, error: SceneError) -> SceneError {
        let (file, place) = (self.file.to_owned(), self.place.clone());
        FileError::Invalid { file, place, error: Box::new(error) }.into()
    }

    /// An error for a value that cannot be where it is.
    pub fn wrong(&self, what: &str, value: &Value, expected: &str) -> FileError {
        wrong_type(self.file, format!("{}: {what}", self.place), value, expected)
    }

    fn read<T>(
        &self,
        field: &str,
        expected: &str,
        convert: impl Fn(&'a Value) -> Option<T>,
    ) -> Result<Option<T>, FileError> {
        let Some(value) = self.get(field) else { return Ok(None) };
        let place = || format!("{}: \"{field}\"", self.place);
        convert(value).map(Some).ok_or_else(|| wrong_type(self.file, place(), value, expected))
    }
}

/// An error for a value of the wrong kind; long values are cut.
pub(super) fn wrong_type(file: &str, place: String, value: &Value, expected: &str) -> FileError {
    FileError::WrongType { file: file.to_owned(), place, found: brief(value), expected: expected.to_owned() }
}

/// The value as JSON, cut to some 40 letters.
pub(super) fn brief(value: &Value) -> String {
    let text = value.to_string();
    match text.char_indices().nth(40) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text,
    }
}

fn as_numbers<const N: usize>(value: &Value) -> Option<[f64; N]> {
    let numbers = value.as_array()?.iter().map(Value::as_f64).collect::<Option<Vec<f64>>>()?;
    numbers.try_into().ok()
}

/// In words, a point or a list of points of so many coordinates.
fn expected(coordinates: usize, list: bool) -> &'static str {
    match (coordinates, list) {
        (2, false) => "two numbers: [x, y]",
        (2, true) => "a list of points: [[x, y], ...]",
        (3, false) => "three numbers: [x, y, z]",
        (3, true) => "a list of points: [[x, y, z], ...]",
        _ => "four numbers: [w, x, y, z]",
    }
}
