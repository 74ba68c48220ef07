//! Exact conversions to and from raw fixed-point integers.

use crate::error::{c_text, check, Result};
use crate::sys;

/// value / per_unit · 2^bits to nearest, ties away from zero, clamped to 64 bits.
pub const fn raw64(value: i64, per_unit: i64, bits: i32) -> i64 {
    clamp64(divide((value as i128) << bits, per_unit as i128))
}

/// The same, clamped to 32 bits.
pub const fn raw32(value: i64, per_unit: i64, bits: i32) -> i32 {
    let raw = raw64(value, per_unit, bits);
    if raw > i32::MAX as i64 {
        i32::MAX
    } else if raw < i32::MIN as i64 {
        i32::MIN
    } else {
        raw as i32
    }
}

/// raw · per_unit · 2^-bits, rounded and clamped in the same way.
pub const fn whole(raw: i64, per_unit: i64, bits: i32) -> i64 {
    clamp64(divide(raw as i128 * per_unit as i128, 1 << bits))
}

const fn divide(numerator: i128, denominator: i128) -> i128 {
    let half = denominator / 2;
    if numerator < 0 {
        (numerator - half) / denominator
    } else {
        (numerator + half) / denominator
    }
}

const fn clamp64(value: i128) -> i64 {
    if value > i64::MAX as i128 {
        i64::MAX
    } else if value < i64::MIN as i128 {
        i64::MIN
    } else {
        value as i64
    }
}

macro_rules! units {
    ($($name:ident: $kind:ty = $convert:ident / $per:literal, $bits:ident;)*) => {
        $(pub const fn $name(value: i64) -> $kind {
            $convert(value, $per, sys::$bits)
        })*
    };
}

units! {
    position_mm: sys::lks_position = raw64 / 1000, LKS_POSITION_BITS;
    position_um: sys::lks_position = raw64 / 1_000_000, LKS_POSITION_BITS;
    length_mm: sys::lks_length = raw32 / 1000, LKS_LENGTH_BITS;
    length_um: sys::lks_length = raw32 / 1_000_000, LKS_LENGTH_BITS;
    velocity_mm_s: sys::lks_velocity = raw64 / 1000, LKS_VELOCITY_BITS;
    angular_velocity_mrad_s: sys::lks_angular_velocity = raw64 / 1000, LKS_ANGULAR_VELOCITY_BITS;
    acceleration_mm_s2: sys::lks_acceleration = raw64 / 1000, LKS_ACCELERATION_BITS;
    impulse_mns: sys::lks_impulse = raw64 / 1000, LKS_IMPULSE_BITS;
    force_mn: sys::lks_force = raw64 / 1000, LKS_FORCE_BITS;
    speed_mm_s: sys::lks_speed = raw32 / 1000, LKS_SPEED_BITS;
    unit_milli: sys::lks_unit = raw32 / 1000, LKS_UNIT_BITS;
    number_milli: sys::lks_number = raw32 / 1000, LKS_NUMBER_BITS;
    rate_milli: sys::lks_rate = raw32 / 1000, LKS_RATE_BITS;
    density_kg_m3: sys::lks_density = raw32 / 1, LKS_DENSITY_BITS;
}

pub const fn position_to_mm(raw: sys::lks_position) -> i64 {
    whole(raw, 1000, sys::LKS_POSITION_BITS)
}
pub const fn velocity_to_mm_s(raw: sys::lks_velocity) -> i64 {
    whole(raw, 1000, sys::LKS_VELOCITY_BITS)
}

pub const fn vec64(x: i64, y: i64, z: i64) -> sys::lks_i64x3 {
    sys::lks_i64x3 { x, y, z }
}
pub const fn vec32(x: i32, y: i32, z: i32) -> sys::lks_i32x3 {
    sys::lks_i32x3 { x, y, z }
}

/// Decimal text ("-9.81") · 2^bits, rounded to nearest.
pub fn decimal(text: &str, bits: i32) -> Result<i64> {
    let text = c_text(text)?;
    let mut out = 0;
    check(unsafe { sys::lks_from_decimal(text.as_ptr(), bits, &mut out) })?;
    Ok(out)
}

/// For drawing alone: nothing computed from it belongs into a world.
pub fn to_f64(raw: i64, bits: i32) -> f64 {
    raw as f64 / (1_i64 << bits) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conversions_round_to_nearest_and_clamp() {
        assert_eq!(position_mm(1500), 3 << 31);
        assert_eq!(position_mm(-1500), -(3 << 31));
        assert_eq!(length_mm(250), 1 << 18);
        assert_eq!(length_mm(i64::MAX), i32::MAX);
        assert_eq!(position_mm(i64::MIN), i64::MIN);
        for mm in [-12_345, -1, 0, 1, 999, 12_345_678] {
            assert_eq!(position_to_mm(position_mm(mm)), mm);
        }
        assert_eq!(decimal("0.25", 20).unwrap(), 1 << 18);
        assert!(decimal("a quarter", 20).is_err());
    }
}
