//! Scene files on disk.

use super::from_json;
use crate::any_scene::AnyScene;
use crate::error::{FileError, SceneError};
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Reads a scene file.
pub fn load(path: impl AsRef<Path>) -> Result<AnyScene, SceneError> {
    let path = path.as_ref();
    let file = path.display().to_string();
    match fs::read_to_string(path) {
        Ok(text) => from_json(&text, &file),
        Err(error) if error.kind() == io::ErrorKind::InvalidData => {
            Err(FileError::Read { file, reason: "it is not text in UTF-8: save it as such".to_owned() }.into())
        }
        Err(error) => Err(FileError::Read { file, reason: error.to_string() }.into()),
    }
}

/// Writes a scene file whole or not at all: into a new file in the same folder, which then takes
/// the name. Whoever reads meanwhile sees the old scene or the new one.
pub fn save(scene: &AnyScene, path: impl AsRef<Path>) -> Result<(), SceneError> {
    let path = path.as_ref();
    let unwritten = |error: io::Error| {
        let (file, reason) = (path.display().to_string(), error.to_string());
        FileError::Write { file, reason }
    };
    let text = scene.to_json(); // if that is stopped on the way, there is no file yet
    let (temporary, file) = create_beside(path).map_err(unwritten)?;
    let result = fill(file, &text).and_then(|()| fs::rename(&temporary, path));
    if result.is_err() {
        // The reason to report is the first error; a leftover is only untidy.
        let _ = fs::remove_file(&temporary);
    }
    Ok(result.map_err(unwritten)?)
}

fn fill(mut file: File, text: &str) -> io::Result<()> {
    file.write_all(text.as_bytes())?;
    file.sync_all()
}

/// A new, empty file in the folder of `path`, under a name that nothing has.
fn create_beside(path: &Path) -> io::Result<(PathBuf, File)> {
    let Some(name) = path.file_name() else {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "the path names no file"));
    };
    for attempt in 0..100 {
        let mut hidden = std::ffi::OsString::from(".");
        hidden.push(name);
        hidden.push(format!(".{}-{attempt}.tmp", std::process::id()));
        let temporary = path.with_file_name(hidden);
        match OpenOptions::new().write(true).create_new(true).open(&temporary) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            opened => return opened.map(|file| (temporary, file)),
        }
    }
    Err(io::Error::new(io::ErrorKind::AlreadyExists, "its folder is full of unfinished files"))
}
