//! The little of the zip format that an `.npz` needs: named entries, stored
//! as they are. Written here because the crates that do it bring three
//! compressors and their C libraries with them.

use std::io::{Error, Result, Write};

/// 1 January 1980, so that the same history gives the same file.
const DATE: u16 = (1 << 5) | 1;
/// Version of the format that reading needs.
const VERSION: u16 = 20;

/// A zip archive being written.
pub struct Archive<'a> {
    out: &'a mut dyn Write,
    directory: Vec<u8>,
    entries: u16,
    offset: u32,
}

impl<'a> Archive<'a> {
    /// An archive without entries.
    pub fn new(out: &'a mut dyn Write) -> Self {
        Self { out, directory: Vec::new(), entries: 0, offset: 0 }
    }

    /// Adds one entry.
    pub fn add(&mut self, name: &str, data: &[u8]) -> Result<()> {
        let size = u32::try_from(data.len()).map_err(|_| too_large())?;
        let name_length = u16::try_from(name.len()).map_err(|_| too_large())?;
        // What the local header and the directory have in common.
        let mut common = Vec::new();
        for half in [VERSION, 0, 0, 0, DATE] {
            common.extend(half.to_le_bytes());
        }
        for word in [checksum(data), size, size] {
            common.extend(word.to_le_bytes());
        }
        common.extend(name_length.to_le_bytes());
        common.extend(0_u16.to_le_bytes());

        self.directory.extend(b"PK\x01\x02");
        self.directory.extend(VERSION.to_le_bytes());
        self.directory.extend(&common);
        // No comment, first disk, binary, no attributes.
        self.directory.extend([0; 10]);
        self.directory.extend(self.offset.to_le_bytes());
        self.directory.extend(name.as_bytes());

        let header = [b"PK\x03\x04".as_slice(), &common, name.as_bytes()].concat();
        self.out.write_all(&header)?;
        self.out.write_all(data)?;
        let written = u32::try_from(header.len()).map_err(|_| too_large())?;
        self.offset = self
            .offset
            .checked_add(written)
            .and_then(|offset| offset.checked_add(size))
            .ok_or_else(too_large)?;
        self.entries = self.entries.checked_add(1).ok_or_else(too_large)?;
        Ok(())
    }

    /// Writes the directory of entries.
    pub fn finish(self) -> Result<()> {
        let size = u32::try_from(self.directory.len()).map_err(|_| too_large())?;
        self.out.write_all(&self.directory)?;
        self.out.write_all(b"PK\x05\x06\0\0\0\0")?;
        for half in [self.entries, self.entries] {
            self.out.write_all(&half.to_le_bytes())?;
        }
        for word in [size, self.offset] {
            self.out.write_all(&word.to_le_bytes())?;
        }
        self.out.write_all(&0_u16.to_le_bytes())
    }
}

fn too_large() -> Error {
    Error::other("an .npz holds at most 4 GB in 65535 columns; write a .csv instead")
}

/// CRC-32 with the reversed polynomial of zip.
fn checksum(data: &[u8]) -> u32 {
    const TABLE: [u32; 256] = table();
    let step = |crc: u32, &byte: &u8| (crc >> 8) ^ TABLE[((crc ^ u32::from(byte)) & 0xff) as usize];
    !data.iter().fold(u32::MAX, step)
}

const fn table() -> [u32; 256] {
    let mut table = [0; 256];
    let mut index = 0;
    while index < 256 {
        let mut crc = index as u32;
        let mut bit = 0;
        while bit < 8 {
            crc = if crc & 1 == 1 { (crc >> 1) ^ 0xedb8_8320 } else { crc >> 1 };
            bit += 1;
        }
        table[index] = crc;
        index += 1;
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checksum_of_the_standard_text() {
        assert_eq!(checksum(b"123456789"), 0xcbf4_3926);
        assert_eq!(checksum(b""), 0);
    }

    #[test]
    fn the_directory_points_at_the_entries() {
        let mut bytes = Vec::new();
        let mut archive = Archive::new(&mut bytes);
        archive.add("first", b"abc").unwrap();
        archive.add("second", b"defgh").unwrap();
        archive.finish().unwrap();
        let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        let end = bytes.len() - 22;
        assert_eq!(&bytes[end..end + 4], b"PK\x05\x06");
        let mut entry = word(end + 16);
        assert_eq!(entry + word(end + 12), end);
        for (name, data) in [("first", b"abc".as_slice()), ("second", b"defgh")] {
            assert_eq!(&bytes[entry..entry + 4], b"PK\x01\x02");
            let local = word(entry + 42);
            assert_eq!(&bytes[local..local + 4], b"PK\x03\x04");
            let start = local + 30 + name.len();
            assert_eq!(&bytes[local + 30..start], name.as_bytes());
            assert_eq!(&bytes[start..start + data.len()], data);
            assert_eq!(word(local + 14), checksum(data) as usize);
            entry += 46 + name.len();
        }
        assert_eq!(entry, end);
    }
}
