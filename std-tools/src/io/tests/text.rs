//! Numbers in text against the standard library's parser, which is the oracle.

use super::super::text::{Decimal, parse_float, parse_integer};
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

/// What is read of the start of a text is what stands there as a word.
#[test]
fn plain_decimals_are_words() {
    let mut random = Random(3);
    let (mut numbers, mut integers) = (0, 0);
    for _ in 0..200_000 {
        let word = word(&mut random);
        let text = format!("{word}{}7", [" ", "\n", "\t", "\r"][random.below(4)]);
        for (bytes, is_all) in [(text.as_bytes(), false), (word.as_bytes(), true)] {
            let Some((decimal, length)) = Decimal::first(bytes, is_all) else { continue };
            assert_eq!(length, word.len(), "{word}");
            if let Some(number) = decimal.float::<f64>() {
                assert_eq!(number.to_bits(), word.parse::<f64>().unwrap().to_bits(), "{word}");
                numbers += 1;
            }
            if let Some(number) = decimal.float::<f32>() {
                assert_eq!(number.to_bits(), word.parse::<f32>().unwrap().to_bits(), "{word}");
            }
            assert_eq!(decimal.integer(), word.parse().ok(), "{word}");
            integers += usize::from(decimal.integer().is_some());
        }
        // It may go on.
        assert!(Decimal::first(word.as_bytes(), false).is_none());
    }
    assert!(numbers > 100_000 && integers > 20_000, "{numbers} numbers, {integers} integers");
}
