//! Amplitudes that do not fit the duration of the run: tables with a later start or an earlier end, and loads with a late start.

use crate::plausibility::usage::amplitudes_over_time;
use crate::report::Report;
use base::names::short;
use deck::Deck;
use mechanics::amplitude::Amplitude;

/// Times are equal within this part of the run: tables are written with six digits or more.
const SAME_TIME: f64 = 1e-6;

/// Part of the peak below which the last value of a record is noise. Held for the rest of the run, it is a small static load.
const FADED: f64 = 1e-3;

/// Warns of tables with nonzero values held beyond their ends, unless the deck asks for it, and of amplitudes equal to zero for the whole
/// run. The deck is sound.
pub fn check_amplitude_ends(deck: &Deck, amplitudes: &[Amplitude], end_time: f64, report: &mut Report) {
    let used = amplitudes_over_time(deck);
    let slack = SAME_TIME * end_time;
    for ((name, words), amplitude) in deck.amplitudes.0.iter().zip(amplitudes) {
        if !used.contains(name.as_str()) {
            continue;
        }
        if let Some(message) = zero_throughout(&name.value, amplitude, end_time) {
            report.warn(&name.span, message, "let the run last longer, or the amplitude begin earlier");
            continue;
        }
        match amplitude {
            Amplitude::Table(_) | Amplitude::Curve(_) => {
                let points = amplitude.points().unwrap_or_default();
                let (Some([first, before]), Some([last, after])) = (points.first(), points.last()) else { continue };
                let peak = points.iter().map(|[_, value]| value.abs()).fold(0.0, f64::max);
                let has_faded = words.file.is_some() && after.abs() <= FADED * peak;
                if words.after.is_none() && *after != 0.0 && !has_faded && *last < end_time - slack {
                    let message = format!(
                        "the table of amplitude `{name}` ends at {}, before the run does: it holds its last value, {}, \
                         to {}",
                        short(*last),
                        short(*after),
                        short(end_time),
                        name = name.value
                    );
                    let hint = "give `after = \"hold\"` if this is meant, or `after = \"zero\"` to end the load there";
                    report.warn(&name.span, message, hint);
                }
                if words.before.is_none() && *before != 0.0 && *first > slack {
                    let message = format!(
                        "the table of amplitude `{name}` begins at {}, after the run does: it has its first value, {}, \
                         from the start",
                        short(*first),
                        short(*before),
                        name = name.value
                    );
                    let hint =
                        "give `before = \"hold\"` if this is meant, or `before = \"zero\"` to begin the load there";
                    report.warn(&name.span, message, hint);
                }
            }
            _ => {}
        }
    }
}

/// The message on an amplitude that is zero from 0 to the end.
fn zero_throughout(name: &str, amplitude: &Amplitude, end_time: f64) -> Option<String> {
    let (rest, slack) = (amplitude.rest(), SAME_TIME * end_time);
    let is_zero = amplitude.harmonic_phase().is_none() && amplitude.value(0.0) == 0.0;
    (is_zero && end_time > 0.0 && rest >= end_time - slack).then(|| match rest.is_finite() {
        true => format!(
            "amplitude `{name}` is zero to the end of the run: it starts at {}, and the run ends at {}",
            short(rest),
            short(end_time)
        ),
        false => format!("amplitude `{name}` is zero from 0 to the end of the run at {}", short(end_time)),
    })
}
