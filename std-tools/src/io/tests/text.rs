//! Numbers in text against the standard library's parser, which is the oracle.

use super::super::text::{parse_float, parse_integer};
use super::Random;

/// A string that is a number, or nearly one.
fn word(random: &mut Random) -> String {
    const SIGNS: [&str; 8] = ["", "", "", "", "-", "-", "+", "--"];
    const DIGITS: [char; 10] = ['0', '1', '2', '3', '4', '5', '6', '7', '8', '9'];
    let mut word = String::from(SIGNS[random.below(8)]);
    for _ in 0..random.below(12) {
        word.push(DIGITS[random.below(10)]);
    }
    if random.below(4) > 0 {
        word.push('.');
        for _ in 0..random.below(12) {
            word.push(DIGITS[random.below(10)]);
        }
    }
    match random.below(12) {
        0 => word += &format!("e{}", random.below(50)),
        1 => word += &format!("E-{}", random.below(340)),
        2 => word += "x",
        3 => word += ".",
        _ => {}
    }
    word
}

#[test]
fn floats_are_those_of_the_standard_library() {
    let mut random = Random(1);
    let words = (0..300_000).map(|_| word(&mut random));
    let special =
        ["", "-", ".", "-.", "0", "-0", "-0.0", "1.", ".5", "inf", "-nan", "9007199254740993", "16777217", "1e400"];
    let mut numbers = 0;
    for word in words.chain(special.map(String::from)) {
        let (double, single) = (word.parse::<f64>().ok(), word.parse::<f32>().ok());
        assert_eq!(parse_float::<f64>(word.as_bytes()).map(f64::to_bits), double.map(f64::to_bits), "{word}");
        assert_eq!(parse_float::<f32>(word.as_bytes()).map(f32::to_bits), single.map(f32::to_bits), "{word}");
        numbers += usize::from(double.is_some());
    }
    assert!(numbers > 100_000);
}

#[test]
fn integers_are_those_of_the_standard_library() {
    let mut random = Random(2);
    let words = (0..100_000).map(|_| word(&mut random));
    let special =
        [i64::MIN.to_string(), i64::MAX.to_string(), "9223372036854775808".into(), "-9223372036854775809".into()];
    for word in words.chain(special) {
        assert_eq!(parse_integer(word.as_bytes()), word.parse().ok(), "{word}");
    }
}
