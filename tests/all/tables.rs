//! Tables of modes as spreadsheets, FE programs and test rigs write them.

use rubscope::machine::{Family, ModeTable, read_modes};

/// Modes as `structure nodal_diameters frequency mass`, for tests.
fn modes(table: &ModeTable) -> Vec<String> {
    let named = ["casing", "disk"].into_iter().zip(&table.modes);
    let mode = |of: &str, mode: &Family| {
        format!("{of} {} {} {}", mode.nodal_diameters, mode.frequency_hz, mode.modal_mass_kg)
    };
    named.flat_map(|(of, modes)| modes.iter().map(move |one| mode(of, one))).collect()
}

const TWO: [&str; 2] = ["casing 2 145 9.8", "disk 2 352 3.9"];

#[test]
fn names_of_programs_are_understood_and_others_are_listed() {
    for head in [
        "Component;ND;Natural frequency [Hz];Modal mass [kg]",
        "Part;Harmonic index;Eigenfrequency (Hz);Generalized mass [kg]",
        "structure;n_d;Freq. [Hz];Mass, kg",
        "Structure (casing or disk);Nodal diameters (ND);FREQUENCY [HZ];Modal-mass [kg]",
    ] {
        for (other, unused) in [
            ("Mass participation [%]", true),
            ("Frequency error [%]", true),
            ("Mass ratio (-)", true),
            ("Damped frequency [furlongs]", true),
            ("Effective mass [kg]", true),
            ("Speed of sound [m/s]", true),
            ("Mass [%]", true),
            ("Structure of the mesh", true),
            ("Remark", true),
            ("Damping ratio [1]", false),
        ] {
            let table = format!("{head};{other}\nCasing;2.0;145;9.8;\nBlisk;2;352;3.9;\n");
            let read = read_modes(table.as_bytes()).unwrap();
            assert_eq!(modes(&read), TWO, "{table}");
            let note = format!("columns not used: {other}");
            assert_eq!(read.notes, [note][..usize::from(unused)], "{table}");
        }
    }
    for (names, said) in [
        (
            "Structure;ND;Frequenz [Hz];Mass [kg]",
            "no column for frequency_hz: understood are natural frequency, eigenfrequency, \
             frequency, freq, with the unit in brackets where there is one; the nearest found \
             is Frequenz [Hz]",
        ),
        ("Structure;ND;Frequency [Hz]", "no column for modal_mass_kg: understood are modal"),
        ("MODE  EIGENVALUE  CYCLES", "it has one cell only: separate cells by semicolons, tabs"),
        (
            "Structure;ND;Frequency [Hz];Effective mass [kg];Remark",
            "the nearest found is Effective mass [kg]",
        ),
        ("Structure;ND;Frequency [Hz];Mass [%]", "Mass [%]: this is a ratio; it takes kg, g"),
        ("Structure;ND;Frequency [Hz];Mass [lbm]", "Mass [lbm]: no unit lbm; it takes kg, g"),
    ] {
        let said_of = read_modes(names.as_bytes()).unwrap_err().to_string();
        assert!(said_of.starts_with("the first line ") && said_of.contains(said), "{said_of}");
    }
    let rows = "\nshroud;2;145;9.8\n";
    let head = "Component;ND;Frequency [Hz];Mass [kg]";
    let refused = read_modes([head, rows].concat().as_bytes()).unwrap_err().to_string();
    let allowed = "casing, housing, stator or disk, disc, bladed disk, bladed disc, blisk, rotor";
    assert_eq!(refused, format!("line 2, structure = shroud: allowed is {allowed}"));
    for word in ["Disk", "disc", "Bladed_disk", "BLISK", "Rotor"] {
        let table = format!("{head}\nhousing;2;145;9.8\n{word};2;352;3.9\n");
        assert_eq!(modes(&read_modes(table.as_bytes()).unwrap()), TWO);
    }
}

#[test]
fn encodings_and_separators_of_programs_are_read_or_the_line_says_what_to_do() {
    let head = "Structure;ND;Frequency [Hz];Mass [kg];Größe in µm";
    let table = format!("{head}\r\ncasing;2;145;9,8;\r\ndisk;2;352;3,9;5\r\n");
    let utf_16 = |order: fn(u16) -> [u8; 2]| table.encode_utf16().flat_map(order).collect();
    let with_mark = |mark: &[u8], text: Vec<u8>| [mark.to_vec(), text].concat();
    let little: Vec<u8> = utf_16(u16::to_le_bytes);
    let big: Vec<u8> = utf_16(u16::to_be_bytes);
    let latin: Vec<u8> = table.chars().map(|c| u8::try_from(u32::from(c)).unwrap()).collect();
    let columns = |table: &str| table.as_bytes().to_vec();
    for bytes in [
        columns(&table),
        with_mark(&[0xef, 0xbb, 0xbf], columns(&table)),
        with_mark(&[0xff, 0xfe], little.clone()),
        with_mark(&[0xfe, 0xff], big.clone()),
        little,
        big,
        latin,
        columns(&format!("sep=;\n{table}")),
        columns(&format!("\"SEP=;\"\r\n{table}")),
        columns(&format!("sep=|\n{}", table.replace(';', "|"))),
        columns(&table.replace(';', "\t")),
        columns(&table.replace(';', "|")),
        // Exponents of Fortran.
        columns(&table.replace(";145;", ";1,450D+02;").replace(";352;", ";0,352d3;")),
        // Empty cells beyond those of the names.
        columns(&table.replace(",8;", ",8;;;")),
    ] {
        let read = read_modes(&bytes).unwrap();
        assert_eq!(modes(&read), TWO, "{bytes:?}");
        assert_eq!(read.notes, ["columns not used: Größe in µm"]);
    }
    let dash = b"Structure,ND,Frequency [Hz],Mass [kg],\x80 \x96\ncasing,2,145,9.8,\n";
    assert_eq!(read_modes(dash).unwrap().notes, ["columns not used: € –"]);
    for (bytes, what) in [
        (&b"PK\x03\x04and so on"[..], "this is a workbook: save the table as CSV in UTF-8"),
        (b"\xff\xfe\x00\xd8a\x00", "this is text in UTF-16 with errors: save"),
        (b"Structure,ND,Frequency\x00,", "this is binary data: save"),
    ] {
        let refused = read_modes(bytes).unwrap_err().to_string();
        assert!(refused.starts_with(what), "{refused}");
    }
}

#[test]
fn lines_of_titles_and_units_around_the_names_are_no_modes() {
    let table = "Modal analysis of stage 3;;;;\n;;;;\nSolver;2024;;;\nStructure;ND;Frequency;\
                 Mass;Speed\n-;-;[kHz];[g];[1/min]\ncasing;2;0,145;9800;\ndisk;2;0,352;3900;0\n";
    let read = read_modes(table.as_bytes()).unwrap();
    assert_eq!(modes(&read), TWO);
    assert_eq!(read.notes, ["lines not used, before the names of the columns: 1, 3"]);
}

#[test]
fn a_pair_is_one_mode_and_a_third_speed_is_fitted() {
    let head = "Structure;Harmonic index;Frequency [Hz];Mass [kg];Speed [rpm]";
    let of = |rows: &str| read_modes(format!("{head}\n{rows}").as_bytes());
    let pair = of("casing;2;145;9,8;\ncasing;-2;145,1;9,8;\ndisk;+2;352;3,9;\ndisk;2;352;3,9;\n");
    let pair = pair.unwrap();
    assert_eq!(modes(&pair), TWO);
    let note = |of, line| {
        format!(
            "second modes of pairs of the {of}, the same as the first ones and not used: line \
             {line}"
        )
    };
    assert_eq!(pair.notes, [note("casing", 3), note("disk", 5)]);
    let at = |rpm: f64, factor: f64| {
        let square = 352.0_f64.powi(2) + 1.6 * (rpm / 60.0).powi(2);
        format!("disk;2;{};3,9;{rpm}\n", factor * square.sqrt()).replace('.', ",")
    };
    let three = of(&[at(0.0, 1.0), at(6000.0, 1.0), at(0.0, 1.0), at(9500.0, 1.0)].concat());
    let three = three.unwrap();
    let [_, disk] = &three.modes;
    assert!((disk[0].frequency_hz / 352.0 - 1.0).abs() < 1e-12, "{disk:?}");
    assert!((disk[0].stiffening.unwrap() / 1.6 - 1.0).abs() < 1e-12, "{disk:?}");
    assert!(three.notes[1].starts_with("disk, 2 nodal diameters, frequency_hz: fitted to 3 sp"));
    // Least squares: 352.001^2, 365.9^2 and 404.99^2 lie on no line.
    let off = of(&[at(0.0, 1.01), at(6000.0, 1.0), at(9500.0, 1.0)].concat()).unwrap();
    assert!(off.notes[0].ends_with("fitted to 3 speeds, at most 0.35 % off"), "{:?}", off.notes);
    for (rows, refusal) in [
        ("casing;2;145;9,8;\ncasing;-2;146;9,8;\n", "line 3, nodal_diameters = 2 twice"),
        ("casing;2;145;9,8;\ncasing;2;145;9,9;\n", "line 3, nodal_diameters = 2 twice"),
        ("disk;2;145;9,8;0\ndisk;2;146;9,8;0\n", "line 3, nodal_diameters = 2 twice"),
        ("disk;2,5;145;9,8;\n", "line 2, nodal_diameters = 2.5: allowed is a whole number"),
    ] {
        let refused = of(rows).unwrap_err().to_string();
        assert!(refused.starts_with(refusal), "{refused}");
    }
}

#[test]
fn numbers_with_two_readings_are_asked_about() {
    let head = "Structure;Nodal diameters;Frequency [Hz];Modal mass [kg];Speed [rpm]";
    for (rows, question) in [
        (
            "casing;5;1.300;8,2;\ncasing;6;1.900;7,9;\n",
            "line 2, frequency_hz = 1.300: is that 1,3000 or 1300 (beside line 2, modal_mass_kg, \
             8,2)? Write it so, without marks between thousands",
        ),
        ("casing;4;440;8;\ncasing;5;1.300;8;\n", "line 3, frequency_hz = 1.300: is that 1.3000"),
        ("disk;5;449,5;3,5;10.000\n", "line 2, speed = 10.000: is that 10,0000 or 10000 (beside"),
        ("disk;5;449.5;3.5;10.000\n", "line 2, speed = 10.000 rpm: is that 10.0000 or 10000?"),
        ("casing;5;1.300,5;8,2;\n", "line 2, frequency_hz = 1.300,5: is that 1300,5?"),
        ("casing;2;145,5;8.2;\n", "line 2, modal_mass_kg = 8.2: which is the decimal mark"),
    ] {
        let asked = read_modes(format!("{head}\n{rows}").as_bytes()).unwrap_err().to_string();
        assert!(asked.contains(question), "{asked}");
    }
    for diameters in ["2.000", "2,0", "2.", "+2"] {
        let row = format!("{head}\ncasing;{diameters};145,0;9,8;\n");
        assert_eq!(modes(&read_modes(row.as_bytes()).unwrap()), TWO[..1]);
    }
}
