//! Files of records.

use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rdsolve::record::{MOST_FAULTS, MotionQuantity, RecordColumn, RecordSelection, RecordUnit, read};

fn select(columns: &[RecordColumn], time_step: Option<f64>) -> RecordSelection {
    RecordSelection { columns: columns.to_vec(), time_step, rows: None, time_unit: None }
}

fn points(text: &str, selection: &RecordSelection) -> Vec<[f64; 2]> {
    read("r", text.as_bytes(), selection).unwrap().points
}

fn name(name: &str) -> RecordColumn {
    RecordColumn::Name(name.into())
}

fn faults(text: &str, selection: &RecordSelection) -> Vec<String> {
    read("r.csv", text.as_bytes(), selection).unwrap_err().into_iter().map(|problem| problem.message).collect()
}

#[test]
fn columns_stand_as_they_do() {
    let wanted = vec![[0.0, 1.0], [0.5, -2.0], [0.5, 3.0]];
    for text in [
        "0,1\n0.5,-2\n0.5,3\n",
        "# a comment\r\n0 1\r\n\r\n5e-1\t-2.0\r\n 0.5  3\r\n",
        "\u{feff}time; acceleration\n0;1\n0.5;-2\n0.5;3",
        "t,a\n0.0,1,\n0.5,-2d0,\n0.5,3,",
    ] {
        assert_eq!(points(text, &select(&[], None)), wanted, "{text:?}");
    }
    let text = "time,\"x\",y\n0,7,1\n1,8,2\n";
    for columns in [[name("time"), name("y")], [RecordColumn::Number(1), RecordColumn::Number(3)]] {
        assert_eq!(points(text, &select(&columns, None)), [[0.0, 1.0], [1.0, 2.0]]);
    }
    let every = select(&[name("x")], Some(0.25));
    assert_eq!(points(text, &every), [[0.0, 7.0], [0.25, 8.0]]);
    assert_eq!(points("3\n4\n5\n", &select(&[], Some(2.0))), [[0.0, 3.0], [2.0, 4.0], [4.0, 5.0]]);
}

#[test]
fn what_is_wrong_is_said() {
    let plain = select(&[], None);
    for (text, selection, said) in [
        ("", &plain, "no lines of numbers"),
        ("t,a\n", &plain, "no numbers"),
        ("0,1\n", &plain, "two values or more"),
        ("0,1\n1,x\n2,y\n", &plain, "`x` is not a finite number"),
        ("0,1\n1,inf\n", &plain, "`inf` is not a finite number"),
        ("0,1\n1,,\n", &plain, "there is a gap: column 2 is empty"),
        ("0 1\n1\n", &plain, "there is a gap: the line has 1 column"),
        ("0,1\n2,1\n1,1\n", &plain, "the time falls: 1 comes after 2"),
        ("0,1\n0,2\n0,3\n", &plain, "more than twice"),
        ("0,1\n1,2,3\n", &plain, "the line has 3 columns, those before it 2"),
        ("t,s,x\n0,1\n", &plain, "the line of names has 3 columns, that of numbers 2"),
        (
            "0\t1\t2\n1\t\t2\n",
            &select(&[RecordColumn::Number(1), RecordColumn::Number(2)], None),
            "there is a gap: column 2 is empty",
        ),
        ("nan\n1\n2\n", &select(&[], Some(1.0)), "`nan` is not a finite number"),
        ("--\n1\n2\n", &select(&[], Some(1.0)), "`--` is not a finite number"),
        ("1\n\n2\n", &select(&[], Some(1.0)), "there is a gap: the line is empty"),
        ("t,x,x\n0,1,2\n1,2,3\n", &select(&[name("t"), name("x")], None), "more than one column is named `x`"),
        ("0\n1\n", &plain, "`time_step` says"),
        (
            "0,1,2\n1,2,3\n",
            &plain,
            "`columns` says which are the time and the value, or `rows = true` with `time_step`",
        ),
        ("t,a,b\n1,2,3\n1,2,3\n", &plain, "`columns` must say which are the time and the value: the file has `t`"),
        ("t,acc\n0,1\n1,2\n", &select(&[name("t"), name("ac")], None), "did you mean `acc`?"),
        ("0,1\n1,2\n", &select(&[RecordColumn::Number(1), RecordColumn::Number(3)], None), "there is no column 3"),
        (
            "0,1\n1,2\n",
            &select(&[], Some(0.1)),
            "a line has 2 values: `columns` says which of them is the value, or `rows = true`",
        ),
        ("0,1\n1,2\n", &select(&[RecordColumn::Number(1), RecordColumn::Number(2)], Some(0.1)), "names one column"),
        ("0,1\n1,2\n", &select(&[RecordColumn::Number(1)], None), "`columns` must be two numbers"),
    ] {
        let found = faults(text, selection);
        assert!(found[0].contains(said), "{text:?}: {found:?}");
    }
    // All that is wrong is said at once, up to a limit.
    assert_eq!(faults("0,1\n1,x\n2,y\n3,4\n", &plain).len(), 2);
    let many: String = (0..100).map(|k| format!("{k},x\n")).collect();
    assert_eq!(faults(&many, &plain).len(), MOST_FAULTS);
}

/// Every dress of the header in which files of the data bases are found, with the same values behind it.
#[test]
fn headers_are_recognized_by_what_they_say() {
    let values = "  .1E-01 -.2000000E-01\r\n 3.0D-2\n\n 0.04 0\n";
    let wanted = vec![[0.0, 0.01], [0.02, -0.02], [0.04, 0.03], [0.06, 0.04], [0.08, 0.0]];
    let peer = |unit: &str, sizes: &str| {
        format!("DATA BASE\nSomewhere, 1/1/1940, 180\nACCELERATION {unit}\n{sizes}\n{values}")
    };
    let unit = "TIME SERIES IN UNITS OF G";
    for sizes in [
        "NPTS=   5, DT=   .0200 SEC,",
        "5    0.0200    NPTS, DT",
        "0.0200  5   DT, NPTS",
        "npts = 5  dt= 2e-2 sec",
        "NPTS=5,DT=0.02SEC",
        "DT= .02 SEC, NPTS= 5",
        "NPTS= 5.0, DT= 2.0D-2 SECONDS",
        "NPTS: 5 DT: .02 SEC, SCALED DATA, SCALE FACTOR= 2.0",
    ] {
        let text = peer(unit, sizes);
        for path in ["r.AT2", "r.txt"] {
            let read = read(path, text.as_bytes(), &select(&[], None)).unwrap();
            assert_eq!(read.points, wanted, "{sizes}");
            assert_eq!(read.unit, Some(RecordUnit::new("G")), "{sizes}");
        }
    }
    let sizes = "NPTS= 5, DT= .02 SEC";
    for (unit, name, known) in [
        ("TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=0.1 Hz LP=40.0 Hz", "G", Some(9.80665)),
        ("TIME HISTORY IN UNITS OF G.", "G", Some(9.80665)),
        ("TIME SERIES IN UNITS OF G (FILTERED)", "G", Some(9.80665)),
        ("IN UNITS OF CM/SEC**2", "CM/SEC**2", Some(0.01)),
        ("IN UNITS OF cm/s/s", "cm/s/s", Some(0.01)),
        ("IN UNITS OF FURLONGS", "FURLONGS", None),
    ] {
        let read = read("r.AT2", peer(unit, sizes).as_bytes(), &select(&[], None)).unwrap();
        assert_eq!(read.points, wanted, "{unit}");
        let found = read.unit.unwrap();
        assert_eq!((found.name.as_str(), found.known.map(|(_, si)| si)), (name, known), "{unit}");
    }
    // Headers whose lines are empty, fewer or more.
    for text in [
        format!("\n\n\nNPTS= 5, DT= .02\n{values}"),
        format!("NPTS= 5, DT= .02\n{values}"),
        format!("a\nb\nc\nd\ne NPTS\nNPTS= 5, DT= .02\nUNITS: m/s^2\nmore of it\n{values}"),
        format!(
            "Orig = a.acc, Scale factor = 2.4 \n  H1: IMPERIAL VALLEY 10/15/79\n azimuth =   233.0\n  Acceleration in g\n5 0.02 NPTS, DT \n{values}"
        ),
        format!("EVENT_NAME: none\nSAMPLING_INTERVAL_S: 0.020000\nNDATA: 5\nUNITS: cm/s^2\nUSER1: \n{values}"),
    ] {
        assert_eq!(points(&text, &select(&[], None)), wanted, "{text}");
    }
}

/// K-NET counts become gal without their offset; CSMIP blocks end at their number of values.
#[test]
fn instruments_write_counts_and_blocks() {
    let knet = "Origin Time       2011/03/11 14:46:00\nMag.              9.0\nSampling Freq(Hz) 100Hz\nDir.              N-S\n\
                Scale Factor      3920(gal)/6182761\nMax. Acc. (gal)   1.0\nMemo.\n 100 200 300\n 400\n";
    let read = rdsolve::record::read("r.NS", knet.as_bytes(), &select(&[], None)).unwrap();
    let gal = 3920.0 / 6182761.0;
    for (point, (time, count)) in read.points.iter().zip([(0.0, -150.0), (0.01, -50.0), (0.02, 50.0), (0.03, 150.0)]) {
        assert!((point[0] - time).abs() < 1e-15 && (point[1] - count * gal).abs() < 1e-12, "{:?}", read.points);
    }
    assert!((read.offset.unwrap() - 250.0 * gal).abs() < 1e-12);
    let csmip = "CORRECTED ACCELEROGRAM\n 1 2 3\n   5 points of accel data equally spaced at  .005 sec, in cm/sec2. (8f10.6)\n\
                 -1.000000 -2.000000-13.000000\n  4.0 5.0\n   5 points of veloc data equally spaced at .005 sec\n 9 9 9 9 9\n";
    let read = rdsolve::record::read("r.V2", csmip.as_bytes(), &select(&[], None)).unwrap();
    assert_eq!(read.points.iter().map(|point| point[1]).collect::<Vec<_>>(), [-1.0, -2.0, -13.0, 4.0, 5.0]);
    assert_eq!(read.unit.unwrap().known, Some((MotionQuantity::Acceleration, 0.01)));
    let twice = format!("{csmip}{csmip}");
    assert!(faults(&twice, &select(&[], None))[0].contains("a second channel"));
}

/// Row by row without a header, whatever separates the values.
#[test]
fn rows_without_a_header() {
    let rows = RecordSelection { rows: Some(true), ..select(&[], Some(0.5)) };
    let wanted = [[0.0, 1.0], [0.5, -2.5], [1.0, 3e-5], [1.5, 4.0]];
    for text in [
        "1 -2.5 3e-5\n4\n",
        "some text\nand more, 5 a line\n1.0,-2.5\n3.0D-5, 4\n",
        "# 1 2 3\n1;-2.5;3e-5;4;",
        "1.0-2.5 3.0-05\n\n4.0",
        "1\n-2.5\n3e-5\n4\n",
    ] {
        assert_eq!(points(text, &rows), wanted, "{text:?}");
    }
    for (text, said) in [
        ("1 2 x\n", "`x` is not a finite number"),
        ("0.5 0.7\n0,1 0,2\n", "`0,1` is not a finite number"),
        ("text alone\n", "two values or more"),
        ("1 ****** 2\n", "`******` is not"),
    ] {
        assert!(faults(text, &rows)[0].contains(said), "{text:?}");
    }
    let no_step = RecordSelection { rows: Some(true), ..select(&[], None) };
    assert!(faults("1 2 3\n4 5\n", &no_step)[0].contains("needs `time_step`"));
}

/// A column out of a sequence jumps by five steps where the lines go by one; channels beside each other do not look like that.
#[test]
fn a_column_out_of_a_sequence_is_noticed() {
    let lines = |value: &dyn Fn(usize, usize) -> f64| -> String {
        (0..100).map(|line| (0..5).map(|k| format!("{} ", value(line, k))).collect::<String>() + "\n").collect()
    };
    let first = select(&[RecordColumn::Number(1)], Some(0.01));
    let sequence = |text: &str| read("r", text.as_bytes(), &first).unwrap().sequence;
    assert_eq!(sequence(&lines(&|line, k| (0.05 * (5 * line + k) as f64).sin())), Some(5));
    assert_eq!(sequence(&lines(&|line, k| (0.05 * line as f64 + k as f64).sin())), None);
}

#[test]
fn what_is_wrong_with_a_header_is_said() {
    let file =
        |sizes: &str, values: &str| format!("DATA BASE\nSomewhere\nACCELERATION IN UNITS OF G\n{sizes}\n{values}\n");
    let sizes = "NPTS= 3, DT= .01 SEC";
    for (text, said, line) in [
        (String::new(), "no line says `NPTS", 1),
        ("a\nb\nc\n".into(), "no line says `NPTS", 1),
        (file("3 values", "1 2 3"), "no line says `NPTS", 1),
        (file("NPTS= 3.5, DT= .01", "1 2 3"), "not `3.5`", 4),
        (file("NPTS= none, DT= .01", "1 2 3"), "not `NONE`", 4),
        (file("NPTS= 1, DT= .01", "1"), "2 or more", 4),
        (file("NPTS= 3, DT= 0", "1 2 3"), "above 0, not `0`", 4),
        (file("NPTS= 3, DT=", "1 2 3"), "no line says `NPTS", 1),
        (file(sizes, "1 2"), "there are 2 values, and NPTS = 3 says more", 5),
        (file(sizes, "1 2\n3 4"), "more values than NPTS = 3", 6),
        (file(sizes, "1 2\nx"), "`x` is not a finite number", 6),
        (file(sizes, "1 nan 3"), "`nan` is not a finite number", 5),
    ] {
        let found = read("r.AT2", text.as_bytes(), &select(&[], None)).unwrap_err();
        assert!(found[0].message.contains(said), "{text:?}: {:?}", found[0].message);
        let place = found[0].excerpt.as_ref().map(|excerpt| excerpt.line);
        assert_eq!(place, Some(line), "{text:?}");
    }
    let other = select(&[], Some(0.02));
    assert!(faults(&file(sizes, "1 2 3"), &other)[0].contains("`time_step` is 0.02, and the header says 0.01"));
    // A last row that is filled with zeros.
    assert_eq!(points(&file(sizes, "1 2\n3 0"), &select(&[], None)).len(), 3);
    // All that is wrong is said at once, up to a limit.
    let many = file("NPTS= 100, DT= 1", &"x\n".repeat(100));
    assert_eq!(read("r.AT2", many.as_bytes(), &select(&[], None)).unwrap_err().len(), MOST_FAULTS);
}

#[test]
fn a_million_points_take_less_than_a_second() {
    let text: String = (0..1_000_000).map(|k| format!("{:.4},{:.6}\n", k as f64 * 0.005, (k as f64).sin())).collect();
    let began = std::time::Instant::now();
    let points = points(&text, &select(&[], None));
    assert_eq!((points.len(), points[999_999][0]), (1_000_000, 4999.995));
    // Half a second would be 0.5 µs a point, three times what it takes; the machine may be busy.
    assert!(began.elapsed().as_secs_f64() < 3.0);
}

/// A file as a data base writes it, in one of its many dresses, with its values, its time step and its unit.
struct Dressed {
    text: String,
    values: Vec<f64>,
    step: f64,
    unit: &'static str,
}

/// The digits of a number in a format of Fortran, and the number that they stand for.
fn digits(format: usize, x: f64) -> (String, f64) {
    let scientific = format!("{x:.7e}");
    let (mantissa, exponent) = scientific.split_once('e').unwrap();
    let exponent: i32 = exponent.parse().unwrap();
    let with =
        |letter: &str| format!("{mantissa}{letter}{}{:02}", if exponent < 0 { '-' } else { '+' }, exponent.abs());
    let text = match format {
        0 => with("E"),
        1 => with("D"),
        2 => with(""),
        3 => format!("{x:.8}"),
        // As `.1234567E-01`: the mantissa below 1, without its zero.
        _ => {
            let sign = if x < 0.0 { "-" } else { "" };
            let digits: String = mantissa.chars().filter(char::is_ascii_digit).collect();
            let exponent = exponent + 1;
            format!("{sign}.{digits}E{}{:02}", if exponent < 0 { '-' } else { '+' }, exponent.abs())
        }
    };
    let value = if format == 3 { text.parse().unwrap() } else { scientific.parse().unwrap() };
    (text, value)
}

fn dressed(random: &mut StdRng) -> Dressed {
    let mut pick = |count: usize| random.random_range(0..count);
    let [format, per_line] = [pick(5), [1, 4, 5, 8][pick(4)]];
    let (count, step) = (20 + pick(380), [0.005, 0.01, 0.0025, 0.02, 0.00390625, 0.0024][pick(6)]);
    let numbers: Vec<(String, f64)> = (0..count)
        .map(|_| digits(format, (pick(2_000_001) as f64 - 1e6) * 1e-6 * 10f64.powi(-(pick(6) as i32))))
        .collect();
    let (separator, end) = (["  ", "\t", " \t "][pick(3)], ["\n", "\r\n"][pick(2)]);
    let (kind, unit) = [("ACCELERATION", "G"), ("VELOCITY", "CM/S"), ("DISPLACEMENT", "CM")][pick(3)];
    let remark =
        ["", ". FILTER POINTS: HP=0.1 Hz LP=40.0 Hz", " (baseline corrected)", ", rotated to fault normal", "\tH1"]
            [pick(5)];
    let title = [format!("{kind} TIME SERIES IN UNITS OF {unit}"), format!("{kind} TIME HISTORY\tIN UNITS OF\t{unit}")];
    let npts =
        [format!("NPTS={count}"), format!("NPTS=  {count}"), format!("NPTS = {count}"), format!("npts: {count}")];
    let dt = [
        format!("DT={step} SEC"),
        format!("DT=   {step} SEC,"),
        format!("DT = {}", step.to_string().trim_start_matches('0')),
        format!("dt= {step:e} seconds"),
        format!("DT={step}s"),
    ];
    let (npts, dt) = (&npts[pick(4)], &dt[pick(5)]);
    let sizes = [
        format!("{npts}, {dt}"),
        format!("{npts} {dt}"),
        format!("{npts}\t{dt}"),
        format!("{npts}, {dt}, Vs30=300 m/s"),
        format!("{dt}, {npts}"),
        format!("{count}   {step}   NPTS, DT"),
        format!("  {step}  {count}  DT, NPTS (sec)"),
    ];
    let station =
        ["Imperial Valley-02, 5/19/1940, El Centro Array #9, 180", "Sylmar - Converter Sta, DT=?, 52"][pick(2)];
    let tail = ["", "", "   ", "END OF FILE", "* processed, 5 per line *", "\u{1a}"][pick(6)];
    let lines: Vec<String> = numbers
        .chunks(per_line)
        .map(|line| line.iter().map(|(text, _)| text.as_str()).collect::<Vec<_>>().join(separator))
        .collect();
    let head =
        ["PEER NGA STRONG MOTION DATABASE RECORD", station, &format!("{}{remark}", title[pick(2)]), &sizes[pick(7)]]
            .join(end);
    let text = format!("{head}{end} {}{end}{tail}", lines.join(&format!("{end} ")));
    Dressed { text, values: numbers.into_iter().map(|(_, value)| value).collect(), step, unit }
}

/// A folder of 230 files in random dresses: every value, time and unit is that which was written.
#[test]
fn records_of_a_whole_folder_are_read_as_they_were_written() {
    let mut random = StdRng::seed_from_u64(230);
    for file in 0..230 {
        let Dressed { text, values, step, unit } = dressed(&mut random);
        let found = read("r.txt", text.as_bytes(), &select(&[], None));
        let found = found.unwrap_or_else(|problems| panic!("{file}: {problems:?}\n{text}"));
        let wanted: Vec<[f64; 2]> = values.iter().enumerate().map(|(k, value)| [k as f64 * step, *value]).collect();
        assert_eq!(found.points, wanted, "{file}\n{text}");
        assert_eq!(found.unit, Some(RecordUnit::new(unit)), "{file}\n{text}");
    }
}

/// The unit of a column stands in its name, or in a line below the names.
#[test]
fn columns_name_their_units() {
    let unit = |text: &str, column: u64| {
        let columns = [RecordColumn::Number(1), RecordColumn::Number(column)];
        read("r.csv", text.as_bytes(), &select(&columns, None)).unwrap().unit
    };
    let named = "Time (s),Acc X (g),u [mm]\n0,1,2\n1,3,4\n";
    assert_eq!(unit(named, 2), Some(RecordUnit::new("g")));
    assert_eq!(unit(named, 3).unwrap().known, Some((MotionQuantity::Displacement, 1e-3)));
    let below = "time,acceleration\ns,m/s\u{b2}\n0,1\n1,3\n";
    assert_eq!(unit(below, 2).unwrap().known, Some((MotionQuantity::Acceleration, 1.0)));
    assert_eq!(points(below, &select(&[], None)), [[0.0, 1.0], [1.0, 3.0]]);
    let share = |name: &str| unit(&format!("t,{name}\n0,1\n1,3\n"), 2).unwrap().known;
    assert_eq!(share("Acc (mg)"), Some((MotionQuantity::Acceleration, 9.80665e-3)));
    assert_eq!(share("Acc [%g]"), Some((MotionQuantity::Acceleration, 9.80665e-2)));
    // Blanks between columns, and between a name and its unit.
    let blanks = "Time (s)  Acc (cm/s2)  Vel (cm/s)\n0.0 1.0 2.0\n0.1 3.0 4.0\n";
    assert_eq!(unit(blanks, 2), Some(RecordUnit::new("cm/s2")));
    assert_eq!(points(blanks, &select(&[name("Time (s)"), name("Vel (cm/s)")], None)), [[0.0, 2.0], [0.1, 4.0]]);
    // Behind a stroke; last in each name, the first being a unit of time; in a comment or a title; below other titles.
    let acceleration = |si: f64| Some((MotionQuantity::Acceleration, si));
    for (head, known) in [
        ("t/s,a/g", acceleration(9.80665)),
        ("time_s,acc_gal", acceleration(0.01)),
        ("Time s,Acc cm/s2", acceleration(0.01)),
        ("% Time(s) Accel(g)", acceleration(9.80665)),
        ("# units: g, dt = 1 s\nt,a", acceleration(9.80665)),
        ("# acceleration in direction x\n# units: gal\nt,a", acceleration(0.01)),
        ("El Centro 1940 NS\nTIME SERIES IN UNITS OF G\nt,a", acceleration(9.80665)),
        ("Corrected Acceleration\n\nTime [sec]\tAcceleration [g]", acceleration(9.80665)),
        ("t;a [m s\u{207b}\u{b2}]\n-----", acceleration(1.0)),
        ("t,\"a, filtered (cm\u{b7}s^-2)\"", acceleration(0.01)),
        // In the codes, a_g is the acceleration of the ground in any unit.
        ("t,a_g", None),
        ("station 7,g", None),
    ] {
        let found = unit(&format!("{head}\n0,1\n1,3\n"), 2);
        assert_eq!(found.and_then(|unit| unit.known), known, "{head}");
    }
    // A name alone is no unit, nor is a word in brackets that is none.
    assert_eq!(unit("t,g\n0,1\n1,3\n", 2), None);
    assert_eq!(unit("t,a (raw)\n0,1\n1,3\n", 2), None);
}

/// Spreadsheets write decimal commas, quotation marks, a line for the separator, empty rows and UTF-16.
#[test]
fn spreadsheets_are_read() {
    let wanted = [[0.0, -0.5], [0.005, 0.25], [0.01, 1250.0]];
    let text = "sep=;\r\nt (s);a (g)\r\n0;-0,5\r\n0,005;2,5e-1\r\n\"0,01\";\"1250\"\r\n;\r\n";
    assert_eq!(points(text, &select(&[], None)), wanted);
    let utf16 = |unit: fn(u16) -> [u8; 2]| format!("\u{feff}{text}").encode_utf16().flat_map(unit).collect::<Vec<u8>>();
    for bytes in [utf16(u16::to_le_bytes), utf16(u16::to_be_bytes)] {
        assert_eq!(read("r.csv", &bytes, &select(&[], None)).unwrap().points, wanted);
    }
    // A comma may separate thousands or columns, and then it stays.
    assert!(faults("1,000 2,500\n2,000 1,500\n", &select(&[], None))[0].contains("a line has 3 values"));
    assert_eq!(points("0,5\n1,7\n", &select(&[], None)), [[0.0, 5.0], [1.0, 7.0]]);
    assert_eq!(points("0, 5\n1, 7\n", &select(&[], None)), [[0.0, 5.0], [1.0, 7.0]]);
}

/// A first line `count step` is a header if the file has as many values as it says.
#[test]
fn a_count_and_a_step_are_a_header() {
    let text = "Station, acceleration in direction x\nUnits: gal\n10 0.02\n1 2 3 4\n5 6 7 8\n9 10\n";
    for rows in [None, Some(true)] {
        let found = points(text, &RecordSelection { rows, ..select(&[], None) });
        assert_eq!((found.len(), found[0], found[9]), (10, [0.0, 1.0], [9.0 * 0.02, 10.0]));
    }
    let unit = read("r", text.as_bytes(), &select(&[], None)).unwrap().unit;
    assert_eq!(unit, Some(RecordUnit::new("gal")));
    assert_eq!(points("10 0.5\n11 0.6\n", &select(&[], None)), [[10.0, 0.5], [11.0, 0.6]]);
}

/// Times are converted to the unit that is asked for if the file names its own: headers of data bases count in seconds.
#[test]
fn times_are_in_the_unit_that_is_asked_for() {
    let peer = "A\nB\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 2, DT= .01 SEC\n1 2\n";
    let csmip = "  2 points of accel data equally spaced at .010 sec, in cm/sec2\n1 2\n";
    for (text, in_seconds, in_milliseconds) in [
        (peer, 0.01, 10.0),
        (csmip, 0.01, 10.0),
        ("time [ms],acc [g]\n0,1\n10,2\n", 0.01, 10.0),
        ("Time (s);acc\n0;1\n0.01;2\n", 0.01, 10.0),
        ("time,acc\nmsec,g\n0,1\n10,2\n", 0.01, 10.0),
        ("t [milliseconds],a\n0,1\n10,2\n", 0.01, 10.0),
        ("t (MSECS),a\n0,1\n10,2\n", 0.01, 10.0),
        ("t [\u{b5}s],a\n0,1\n1e4,2\n", 0.01, 10.0),
        ("t [ns],a\n0,1\n1e7,2\n", 0.01, 10.0),
        ("t (minute),a\n0,1\n0.5,2\n", 30.0, 3e4),
        ("t [h],a\n0,1\n0.5,2\n", 1800.0, 1.8e6),
        ("t [furlongs],a\n0,1\n10,2\n", 10.0, 10.0),
        // Without a unit of the file, numbers stay.
        ("t,a\n0,1\n10,2\n", 10.0, 10.0),
    ] {
        for (unit, wanted) in [(1.0, in_seconds), (1e-3, in_milliseconds)] {
            let asked = RecordSelection { time_unit: Some(unit), ..select(&[], None) };
            let found = points(text, &asked);
            // Quotients of powers of ten round.
            assert!(found[0] == [0.0, 1.0] && found[1][1] == 2.0, "{text}");
            assert!((found[1][0] / wanted - 1.0).abs() < 1e-15, "{text}");
        }
    }
}

/// The header of CSMIP names the unit in several ways.
#[test]
fn headers_of_csmip_name_their_unit() {
    for unit in [
        "in cm/sec2",
        "(UNITS: CM/SEC/SEC)",
        "(units: cm/sec2).",
        "approx 5 secs, units=cm/sec2(04),Format=(8F10.3)",
        "units = cm/sec2",
        "(Units : cm/sec2)",
    ] {
        let text = format!("  3 POINTS OF ACCEL DATA EQUALLY SPACED AT   .020 SEC. {unit}\n  1.0 2.0 3.0\n");
        let found = read("r", text.as_bytes(), &select(&[], None)).unwrap();
        assert_eq!(found.points, [[0.0, 1.0], [0.02, 2.0], [0.04, 3.0]], "{unit}");
        assert_eq!(found.unit.unwrap().known, Some((MotionQuantity::Acceleration, 0.01)), "{unit}");
    }
}

/// Files of other data bases are named, with the way round.
#[test]
fn files_that_are_not_read_are_named() {
    for (first, kind) in
        [("Corrected acceleration   (Format v01.20 with 13 text lines)", "COSMOS"), ("2 CORRECTED ACCELEROGRAM", "SMC")]
    {
        let said = faults(&format!("{first}\n1 2 3\n"), &select(&[], None));
        assert_eq!(said, [format!("this is a file of {kind}, which rdsolve does not read")]);
    }
    // A comment that speaks of them is none of them.
    let one_column = "# uncorrected accelerogram\n1\n3\n";
    assert_eq!(points(one_column, &select(&[], Some(0.5))), [[0.0, 1.0], [0.5, 3.0]]);
}
