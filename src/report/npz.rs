//! A history for numpy: `numpy.load(file)["u_c_m"]` is the column of that
//! name. An `.npz` is a zip of `.npy` arrays. The arrays `version`, `commit`, `command`
//! and `scene` (a scene file) are texts: `numpy.load(file)["scene"].item()`.

use std::io::{Error, Result, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use super::command::{COMMIT, VERSION};
use super::{History, Provenance};

/// Hides the first error of the writer from the archive, which would print it in its own words.
struct Quiet<'a> {
    out: &'a mut dyn Write,
    trouble: Result<()>,
}

impl Write for Quiet<'_> {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        if self.trouble.is_ok() {
            self.trouble = self.out.write_all(bytes);
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Result<()> {
        Ok(())
    }
}

/// Writes a history and where it comes from.
///
/// # Errors
/// An error of the writer.
pub fn write(history: &History, origin: &Provenance, out: &mut dyn Write) -> Result<()> {
    let mut quiet = Quiet { out, trouble: Ok(()) };
    let mut archive = ZipWriter::new_stream(&mut quiet);
    // A fixed date, so that the same history gives the same file.
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Stored)
        .last_modified_time(DateTime::default());
    let mut add = |name: &str, array: Vec<u8>| {
        archive.start_file(format!("{name}.npy"), options).map_err(Error::other)?;
        archive.write_all(&array)
    };
    for values in history.columns() {
        add(&values.name, column(&values.values))?;
    }
    add("version", text(VERSION))?;
    add("commit", text(COMMIT))?;
    add("command", text(&origin.command.to_string()))?;
    add("scene", text(&origin.scene.to_toml()))?;
    archive.finish().map_err(Error::other)?;
    quiet.trouble
}

/// Signature and version (1.0) of a `.npy` array, and the length of the rest of its header: the
/// values begin after 128 bytes.
const START: &[u8; 10] = b"\x93NUMPY\x01\x00\x76\x00";

/// Returns an array of numpy whose type and shape are written as in Python.
fn array(kind: &str, shape: &str, values: impl Iterator<Item = u8>) -> Vec<u8> {
    let header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}");
    START.iter().copied().chain(format!("{header:117}\n").into_bytes()).chain(values).collect()
}

/// Returns an array of one dimension.
fn column(values: &[f64]) -> Vec<u8> {
    let bytes = values.iter().flat_map(|value| value.to_le_bytes());
    array("<f8", &format!("({}, )", values.len()), bytes)
}

/// Returns a text as numpy's Unicode scalar: an array without dimensions.
fn text(text: &str) -> Vec<u8> {
    let bytes = text.chars().flat_map(|letter| u32::from(letter).to_le_bytes());
    array(&format!("<U{}", text.chars().count()), "()", bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A disk with room for so many bytes.
    struct Disk(usize);

    impl Write for Disk {
        fn write(&mut self, bytes: &[u8]) -> Result<usize> {
            let Some(room) = self.0.checked_sub(bytes.len()) else {
                return Err(Error::new(std::io::ErrorKind::StorageFull, "the disk is full"));
            };
            self.0 = room;
            Ok(bytes.len())
        }

        fn flush(&mut self) -> Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_full_disk_is_told_in_the_words_of_the_disk_wherever_it_comes() {
        let scene = rubscope_solver::scene::Scene::base();
        let command = crate::report::CommandLine::new("run", &scene);
        let (history, origin) = (History::new(0), Provenance { command, scene });
        let room = |room| write(&history, &origin, &mut Disk(room));
        let enough = (0..).step_by(1000).find(|bytes| room(*bytes).is_ok()).unwrap();
        assert!(enough > 5000);
        for bytes in (0..enough - 1000).step_by(7) {
            assert_eq!(room(bytes).unwrap_err().to_string(), "the disk is full", "{bytes}");
        }
    }

    #[test]
    fn the_values_follow_a_header_of_128_bytes() {
        for count in [0_u32, 1, 12_345] {
            let values: Vec<f64> = (0..count).map(|n| f64::from(n) / 3.0).collect();
            let bytes = column(&values);
            let (header, data) = bytes.split_at(128);
            assert_eq!(&header[..10], b"\x93NUMPY\x01\x00v\x00");
            let words = format!(
                "{{'descr': '<f8', 'fortran_order': False, 'shape': ({count}, ), }}{}\n",
                " ".repeat(60 - count.to_string().len())
            );
            assert_eq!(std::str::from_utf8(&header[10..]).unwrap(), words);
            let read: Vec<f64> =
                data.chunks(8).map(|bytes| f64::from_le_bytes(bytes.try_into().unwrap())).collect();
            assert_eq!(read, values);
        }
    }

    #[test]
    fn a_text_has_four_bytes_a_character() {
        let bytes = text("0 Ω\n");
        assert_eq!(&bytes[10..65], b"{'descr': '<U4', 'fortran_order': False, 'shape': (), }");
        assert_eq!(&bytes[127..], b"\n0\0\0\0 \0\0\0\xa9\x03\0\0\n\0\0\0");
        assert_eq!(text("").len(), 128);
    }
}
