//! Steel profiles by name against the tables of the standards: areas and second moments.

use crate::support::read_deck;
use rdsolve::model::Model;

/// Area in cm² and second moments about the strong and the weak axis in cm⁴ as tables of rolling mills print them.
const TABLES: [(&str, [f64; 3]); 79] = [
    ("IPE 80", [7.64, 80.1, 8.49]),
    ("IPE 100", [10.3, 171.0, 15.9]),
    ("IPE 120", [13.2, 318.0, 27.7]),
    ("IPE 140", [16.4, 541.0, 44.9]),
    ("IPE 160", [20.1, 869.0, 68.3]),
    ("IPE 180", [23.9, 1317.0, 101.0]),
    ("IPE 200", [28.5, 1943.0, 142.0]),
    ("IPE 220", [33.4, 2772.0, 205.0]),
    ("IPE 240", [39.1, 3892.0, 284.0]),
    ("IPE 270", [45.9, 5790.0, 420.0]),
    ("IPE 300", [53.8, 8356.0, 604.0]),
    ("IPE 330", [62.6, 11770.0, 788.0]),
    ("IPE 360", [72.7, 16270.0, 1043.0]),
    ("IPE 400", [84.5, 23130.0, 1318.0]),
    ("IPE 450", [98.8, 33740.0, 1676.0]),
    ("IPE 500", [116.0, 48200.0, 2142.0]),
    ("IPE 550", [134.0, 67120.0, 2668.0]),
    ("IPE 600", [156.0, 92080.0, 3387.0]),
    ("HEA 100", [21.2, 349.0, 134.0]),
    ("HEA 120", [25.3, 606.0, 231.0]),
    ("HEA 140", [31.4, 1033.0, 389.0]),
    ("HEA 160", [38.8, 1673.0, 616.0]),
    ("HEA 180", [45.3, 2510.0, 925.0]),
    ("HEA 200", [53.8, 3692.0, 1336.0]),
    ("HEA 220", [64.3, 5410.0, 1955.0]),
    ("HEA 240", [76.8, 7763.0, 2769.0]),
    ("HEA 260", [86.8, 10450.0, 3668.0]),
    ("HEA 280", [97.3, 13670.0, 4763.0]),
    ("HEA 300", [112.5, 18260.0, 6310.0]),
    ("HEA 320", [124.4, 22930.0, 6985.0]),
    ("HEA 340", [133.5, 27690.0, 7436.0]),
    ("HEA 360", [142.8, 33090.0, 7887.0]),
    ("HEA 400", [159.0, 45070.0, 8564.0]),
    ("HEA 450", [178.0, 63720.0, 9465.0]),
    ("HEA 500", [197.5, 86970.0, 10370.0]),
    ("HEA 550", [211.8, 111900.0, 10820.0]),
    ("HEA 600", [226.5, 141200.0, 11270.0]),
    ("HEA 650", [241.6, 175200.0, 11720.0]),
    ("HEA 700", [260.5, 215300.0, 12180.0]),
    ("HEA 800", [285.8, 303400.0, 12640.0]),
    ("HEA 900", [320.5, 422100.0, 13550.0]),
    ("HEA 1000", [346.8, 553800.0, 14000.0]),
    ("HEB 100", [26.0, 450.0, 167.0]),
    ("HEB 120", [34.0, 864.0, 318.0]),
    ("HEB 140", [43.0, 1509.0, 550.0]),
    ("HEB 160", [54.3, 2492.0, 889.0]),
    ("HEB 180", [65.3, 3831.0, 1363.0]),
    ("HEB 200", [78.1, 5696.0, 2003.0]),
    ("HEB 220", [91.0, 8091.0, 2843.0]),
    ("HEB 240", [106.0, 11260.0, 3923.0]),
    ("HEB 260", [118.4, 14920.0, 5135.0]),
    ("HEB 280", [131.4, 19270.0, 6595.0]),
    ("HEB 300", [149.1, 25170.0, 8563.0]),
    ("HEB 320", [161.3, 30820.0, 9239.0]),
    ("HEB 340", [170.9, 36660.0, 9690.0]),
    ("HEB 360", [180.6, 43190.0, 10140.0]),
    ("HEB 400", [197.8, 57680.0, 10820.0]),
    ("HEB 450", [218.0, 79890.0, 11720.0]),
    ("HEB 500", [238.6, 107200.0, 12620.0]),
    ("HEB 550", [254.1, 136700.0, 13080.0]),
    ("HEB 600", [270.0, 171000.0, 13530.0]),
    ("HEB 650", [286.3, 210600.0, 13980.0]),
    ("HEB 700", [306.4, 256900.0, 14440.0]),
    ("HEB 800", [334.2, 359100.0, 14900.0]),
    ("HEB 900", [371.3, 494100.0, 15820.0]),
    ("HEB 1000", [400.0, 644700.0, 16280.0]),
    ("L 40x4", [3.08, 4.47, 4.47]),
    ("L 50x5", [4.8, 11.0, 11.0]),
    ("L 60x6", [6.91, 22.8, 22.8]),
    ("L 70x7", [9.4, 42.3, 42.3]),
    ("L 75x8", [11.4, 59.1, 59.1]),
    ("L 80x8", [12.3, 72.2, 72.2]),
    ("L 90x9", [15.5, 116.0, 116.0]),
    ("L 100x10", [19.2, 177.0, 177.0]),
    ("L 100x12", [22.7, 207.0, 207.0]),
    ("L 120x12", [27.5, 368.0, 368.0]),
    ("L 150x15", [43.0, 898.0, 898.0]),
    ("L 180x18", [61.9, 1870.0, 1870.0]),
    ("L 200x20", [76.3, 2850.0, 2850.0]),
];

/// A cantilever of one element for each profile, in metres.
fn beams(names: &[&str], head: &str, unit: &str) -> Model {
    let mut text = format!(
        "{head}[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 1.0\n[materials.m]\nmodel = \"elastic\"\n\
        youngs_modulus = 1e11\npoisson_ratio = 0.0\n[points]\n"
    );
    for k in 0..names.len() {
        text += &format!("a{k} = [0.0, {k}.0, 0.0]\nb{k} = [10.0, {k}.0, 0.0]\n");
    }
    for (k, name) in names.iter().enumerate() {
        text += &format!(
            "[sections.s{k}]\nprofile = \"{name}\"\n{unit}[[beams]]\nname = \"beam {k}\"\npath = [\"a{k}\", \"b{k}\"]\n\
            elements = 1\nmaterial = \"m\"\nsection = \"s{k}\"\norientation = [0.0, 1.0, 0.0]\n[[supports]]\nat = \"a{k}\"\nfix = \"all\"\n"
        );
    }
    read_deck(&text)
}

/// Tables have three or four digits: 0.5 % of the smallest three, 10.3.
#[test]
fn profiles_are_those_of_the_tables() {
    let names: Vec<&str> = TABLES.iter().map(|(name, _)| *name).collect();
    let model = beams(&names, "units = \"SI\"\n", "");
    assert_eq!(model.stiffnesses.len(), TABLES.len());
    for ((name, known), stiffness) in TABLES.iter().zip(&model.stiffnesses) {
        // E A, E I_y and E I_z over E, in cm.
        let found =
            [stiffness.N[(0, 0)] / 1e11 * 1e4, stiffness.M[(1, 1)] / 1e11 * 1e8, stiffness.M[(2, 2)] / 1e11 * 1e8];
        for (found, known) in found.iter().zip(known) {
            assert!((found / known - 1.0).abs() < 5e-3, "{name}: {found} for {known}");
        }
    }
}

/// In millimetres, by `units` or by `unit`, a profile has the same numbers of millimetres; pipes are tubes.
#[test]
fn units_of_length_are_those_of_the_deck() {
    let names = ["IPE 200", "CHS 114.3x5", "SHS 100x5", "RHS 200x100x8"];
    let in_metres = beams(&names, "units = \"SI\"\n", "");
    for (head, unit, size) in
        [("", "unit = \"m\"\n", 1.0), ("units = \"mm-t-s\"\n", "", 1e3), ("", "unit = \"in\"\n", 1e3 / 25.4)]
    {
        for (own, metres) in beams(&names, head, unit).stiffnesses.iter().zip(&in_metres.stiffnesses) {
            assert!((own.N[(0, 0)] / metres.N[(0, 0)] / (size * size) - 1.0).abs() < 1e-12);
            assert!((own.M[(1, 1)] / metres.M[(1, 1)] / f64::powi(size, 4) - 1.0).abs() < 1e-12);
        }
    }
    let pipe = std::f64::consts::PI / 4.0 * (0.1143_f64.powi(2) - 0.1043_f64.powi(2));
    assert!((in_metres.stiffnesses[1].N[(0, 0)] / 1e11 / pipe - 1.0).abs() < 1e-12);
}
