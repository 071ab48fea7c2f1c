//! Inputs mutated from others, the same ones for the same seed.

use asperity::scene::fields::{FIELDS, Range};

/// Patches that trip readers of numbers and of nested text, separated by blanks; others have
/// blanks in them.
const NASTY: &str = "NaN inf -inf -0.0 1e999 1e-999 1e308 -1e308 5e-324 18446744073709551615 18446744073709551616 -1 0 \
    268435456 1e99999999999 0x7f 1_000 None Some( ) ( [ ] { } , : = \" ' \\ \\u{1b} r#\" \"# // /* */ # \
    #![enable(unwrap_newtypes)] ; \u{feff} \u{1b}[2J \u{0} µ κ ° ² − é \u{202e} k M Ki E mm Pa J/m^2 m^(1−n) rad \
    ToForce(1e-3) ToIndentation(-1e-7) ToTouch ToZeroForce ToSeparation";
const BLANKS: [&str; 4] = ["\n", "\r\n", "\t", " "];

/// Mutates inputs.
pub struct Mutator<'a> {
    state: u64,
    inputs: &'a [Vec<u8>],
    tokens: Vec<&'static str>,
    longest: usize,
}

impl<'a> Mutator<'a> {
    /// A mutator of these inputs, at least one; its results are at most `longest` bytes long.
    pub fn new(seed: u64, inputs: &'a [Vec<u8>], longest: usize) -> Self {
        let mut tokens: Vec<&str> = NASTY.split(' ').chain(BLANKS).collect();
        for field in FIELDS {
            tokens.extend([field.path, field.last(), field.default]);
            if let Range::Choice(of) | Range::List { of, .. } = field.range {
                tokens.extend(of);
            }
        }
        // xorshift stays at zero.
        Mutator {
            state: seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1,
            inputs,
            tokens,
            longest,
        }
    }

    /// A number below `count`, which is above 0, by xorshift64* (Vigna 2016).
    fn below(&mut self, count: usize) -> usize {
        self.state ^= self.state >> 12;
        self.state ^= self.state << 25;
        self.state ^= self.state >> 27;
        ((u128::from(self.state.wrapping_mul(0x2545_f491_4f6c_dd1d)) * count as u128) >> 64)
            as usize
    }

    /// A part of `input`, mostly a short one.
    fn part(&mut self, input: &[u8]) -> std::ops::Range<usize> {
        let start = self.below(input.len() + 1);
        let most = if self.below(4) == 0 { input.len() } else { 8 };
        start..(start + self.below(most + 1)).min(input.len())
    }

    /// The number nearest after some place: digits, point, exponent and sign.
    fn number(&mut self, input: &[u8]) -> std::ops::Range<usize> {
        let from = self.below(input.len() + 1);
        let is_part = |byte: &u8| byte.is_ascii_digit() || b".eE+-".contains(byte);
        let start = input[from..]
            .iter()
            .position(u8::is_ascii_digit)
            .map_or(from, |at| from + at);
        let length = input[start..]
            .iter()
            .position(|byte| !is_part(byte))
            .unwrap_or(input.len() - start);
        start..start + length
    }

    fn other(&mut self) -> &'a Vec<u8> {
        let index = self.below(self.inputs.len());
        &self.inputs[index]
    }

    /// The next input: an existing one, changed in one to eight places.
    pub fn next_input(&mut self) -> Vec<u8> {
        let mut input = self.other().clone();
        for _ in 0..1 << self.below(4) {
            let (part, place) = (self.part(&input), self.below(input.len() + 1));
            let token = self.below(self.tokens.len());
            let token = self.tokens[token].bytes();
            match self.below(8) {
                0 => {
                    if let Some(byte) = input.get_mut(place) {
                        *byte ^= 1 << self.below(8);
                    }
                }
                1 => drop(input.drain(part)),
                2 => {
                    let again = input[part].to_vec();
                    input.splice(place..place, again);
                }
                3 => drop(input.splice(place..place, token)),
                4 => drop(input.splice(part, token)),
                5 | 6 => {
                    let number = self.number(&input);
                    input.splice(number, token);
                }
                _ => {
                    let other = self.other();
                    input.splice(part, other[self.part(other)].iter().copied());
                }
            }
        }
        input.truncate(self.longest);
        input
    }
}
