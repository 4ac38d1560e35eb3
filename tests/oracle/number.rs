//! Numbers of 90 digits.
#![allow(clippy::needless_pass_by_value, reason = "the sums are written in place")]

use std::cell::RefCell;
use std::rc::Rc;

use dashu_float::round::mode::HalfEven;
use dashu_float::{CachedFBig, ConstCache, FBig};

/// Binary digits of every value. The definitions cancel up to 40 decimal digits in the corners of
/// the envelope, and fifty must remain.
const PRECISION: usize = 300;

/// A number of 90 digits.
pub(crate) type Big = CachedFBig<HalfEven, 2>;

thread_local! {
    static CONSTANTS: Rc<RefCell<ConstCache>> = Rc::new(RefCell::new(ConstCache::new()));
}

/// A double as an exact number.
pub(crate) fn big(value: f64) -> Big {
    let exact = FBig::<HalfEven, 2>::try_from(value).expect("a finite number");
    CONSTANTS.with(|constants| Big::new(exact.with_precision(PRECISION).value(), constants.clone()))
}

pub(crate) fn whole(value: i64) -> Big {
    let exact = FBig::<HalfEven, 2>::from(value);
    CONSTANTS.with(|constants| Big::new(exact.with_precision(PRECISION).value(), constants.clone()))
}

/// A printed decimal, such as `3.867`.
pub(crate) fn decimal(printed: &str) -> Big {
    let (sign, digits) = printed.strip_prefix('-').map_or((1, printed), |rest| (-1, rest));
    let (mantissa, exponent) = digits.split_once('e').unwrap_or((digits, "0"));
    let (before, after) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let mut value = whole(0);
    for digit in before.chars().chain(after.chars()) {
        value = value * 10 + whole(digit.to_digit(10).expect("a digit").into());
    }
    let places = exponent.parse::<i32>().expect("an exponent")
        - i32::try_from(after.len()).expect("a short decimal");
    sign * value * power_of_ten(places)
}

fn power_of_ten(exponent: i32) -> Big {
    let power = (0..exponent.abs()).fold(whole(1), |power, _| power * 10);
    if exponent < 0 { 1 / power } else { power }
}

/// π.
pub(crate) fn pi() -> Big {
    CONSTANTS.with(|constants| Big::pi(PRECISION, constants))
}

/// √x.
pub(crate) fn root(value: Big) -> Big {
    value.sqrt()
}

/// ln x.
pub(crate) fn logarithm(value: Big) -> Big {
    value.ln()
}

/// sin x.
pub(crate) fn sine(value: Big) -> Big {
    value.sin()
}

/// The nearest double.
pub(crate) fn rounded(value: &Big) -> f64 {
    value.to_f64().value()
}

/// Twenty-two significant digits, as `d.ddde-n`.
pub(crate) fn printed(value: &Big) -> String {
    const DIGITS: i32 = 21;
    let near = rounded(value);
    if near == 0.0 {
        return "0".to_owned();
    }
    let sign = if near < 0.0 { "-" } else { "" };
    let positive = if near < 0.0 { -value } else { value.clone() };
    let mut exponent = near.abs().log10().floor() as i32;
    let digits_at = |exponent: i32| {
        (&positive * power_of_ten(DIGITS - exponent)).round().to_int().value().to_string()
    };
    let mut digits = digits_at(exponent);
    if digits.len() != DIGITS as usize + 1 {
        exponent += if digits.len() > DIGITS as usize + 1 { 1 } else { -1 };
        digits = digits_at(exponent);
    }
    let rest = digits[1..].trim_end_matches('0');
    let point = if rest.is_empty() { "" } else { "." };
    format!("{sign}{}{point}{rest}e{exponent}", &digits[..1])
}
