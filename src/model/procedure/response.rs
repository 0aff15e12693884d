//! The frequency response of `[analysis]`, and what excites it: loads and motions with amplitudes of kind "harmonic".

use crate::data::{
    self, AroundResonances, Expect, ExpectAt, ModeExtent, OverFrequencies, ResponseAsked, ResponseMethod,
};
use crate::plausibility::usage::amplitudes_over_time;
use crate::procedure::extent::extent as given_extent;
use crate::report::{Owner, Report};
use crate::values::{chosen, keys};
use base::diagnostic::{At, Span};
use deck::Deck;
use deck::amplitudes::AmplitudeKind;
use deck::analysis::{Analysis, AnalysisKind, ResponseWord};
use deck::loads::Load;
use deck::stages::StageKind;
use deck::words::{Frequencies, FrequencyRange, Spacing};
use mechanics::amplitude::Amplitude;

/// Most frequencies of a response.
const MOST: u64 = 1_000_000;
/// Most frequencies on each side of a natural one.
const MOST_AROUND: u64 = 1000;
/// Modes up to this multiple of the highest frequency answer with their inertia, unless the deck says otherwise.
const BEYOND: f64 = 4.0;

/// The keys of `[analysis]` that a frequency response alone has.
pub fn keys_of_response(analysis: &Analysis) -> [(&'static str, Option<&Span>); 3] {
    keys!(analysis; frequencies, method, damping_ratio)
}

/// Reads the keys of a frequency response, with the modes that its method needs.
pub fn response<'d>(analysis: &'d Analysis, place: &'d Span, report: &mut Report<'d>) -> ResponseAsked {
    let what = "a frequency response";
    report.reject_unused(what, &keys!(analysis; damped, speeds));
    let method = match chosen(&analysis.method) {
        ResponseWord::Direct => ResponseMethod::Direct,
        ResponseWord::Modal => ResponseMethod::Modal,
    };
    if method == ResponseMethod::Direct {
        let of_modes = keys!(analysis; modes, up_to, damping_ratio);
        report.reject_unused("the direct solution of a frequency response (`method = \"modal\"`)", &of_modes);
    }
    let damping_ratio = report.not_negative("damping_ratio", &analysis.damping_ratio, 0.0);
    let owner = Owner::new("a frequency response", place);
    let given = report.require(&owner, "frequencies", &analysis.frequencies);
    let (mut frequencies, resonances) = given.map_or((Vec::new(), None), |at| frequencies(at, report));
    frequencies.sort_by(f64::total_cmp);
    frequencies.dedup();
    if let Some(at) = analysis.damping_ratio.as_ref().filter(|at| at.value >= 1.0) {
        report.warn(
            &at.span,
            "with this damping nothing vibrates",
            "give the ratio to critical damping, such as 0.02 for 2 %",
        );
    }
    let extent_is_open = analysis.modes.is_none() && analysis.up_to.is_none();
    let extent = if extent_is_open { extent(&frequencies) } else { given_extent(analysis, report) };
    ResponseAsked { frequencies, resonances, method, damping_ratio, extent, extent_is_open }
}

/// The modes that answer with their inertia, unless the deck says otherwise.
fn extent(frequencies: &[f64]) -> ModeExtent {
    let highest = frequencies.last().copied().unwrap_or(1.0);
    ModeExtent::UpTo(BEYOND * highest.max(f64::MIN_POSITIVE))
}

/// The frequencies of the deck.
fn frequencies<'d>(at: &'d At<Frequencies>, report: &mut Report<'d>) -> (Vec<f64>, Option<AroundResonances>) {
    let mut not_negative = |at: &At<f64>| {
        let sound = at.value >= 0.0 && at.value.is_finite();
        if !sound {
            report.error::<()>(&at.span, "a frequency must not be negative");
        }
        sound
    };
    match &at.value {
        Frequencies::Listed(list) => {
            let sound = list.iter().filter(|at| not_negative(at)).map(|at| at.value).collect::<Vec<_>>();
            if list.is_empty() {
                report.error::<()>(&at.span, "`frequencies` is empty");
            }
            (sound, None)
        }
        Frequencies::Range(range) => {
            let sound = not_negative(&range.from) & not_negative(&range.to);
            if sound { in_range(range, report) } else { (Vec::new(), None) }
        }
    }
}

fn in_range<'d>(range: &'d FrequencyRange, report: &mut Report<'d>) -> (Vec<f64>, Option<AroundResonances>) {
    let (from, to) = (range.from.value, range.to.value);
    let spacing = range.spacing.as_ref().map_or(Spacing::Linear, |at| at.value);
    let steps = range.steps.value;
    let fault = match () {
        () if to < from => Some((&range.to.span, format!("`to` must not be below `from`, which is {from}"))),
        () if spacing == Spacing::Logarithmic && from == 0.0 => {
            Some((&range.from.span, "`from` must be above zero with logarithmic spacing".to_owned()))
        }
        () if steps == 0 => Some((&range.steps.span, "`steps` must be at least 1".to_owned())),
        () if steps > MOST => Some((&range.steps.span, format!("`steps` is at most {MOST}"))),
        () if steps == 1 && to > from => {
            Some((&range.steps.span, "from `from` to `to` there are at least 2 frequencies".to_owned()))
        }
        () => None,
    };
    if let Some((place, message)) = fault {
        return report.error(place, message).unwrap_or_default();
    }
    let around = range.around_resonances.as_ref().filter(|at| at.value > 0);
    if let Some(around) = around.filter(|at| at.value > MOST_AROUND) {
        return report.error(&around.span, format!("`around_resonances` is at most {MOST_AROUND}")).unwrap_or_default();
    }
    let around = around.map(|at| AroundResonances { range: [from, to], count: at.value as usize });
    (spacing.between(from, to, steps as usize), around)
}

/// Notes a table of reactions in a frequency response: it has the state at rest.
pub fn note_tables_of_state(deck: &Deck, report: &mut Report) {
    let is_response =
        |analysis: &Analysis| analysis.kind.as_ref().is_some_and(|at| at.value == AnalysisKind::FrequencyResponse);
    let output = deck.output.as_ref().filter(|_| deck.analysis.as_ref().is_some_and(|at| is_response(at)));
    let Some(at) = output.and_then(|output| output.reactions.as_ref()).filter(|at| at.value) else { return };
    let message = "reactions.csv has the reactions in the state at rest, not those of the response";
    let hint = "model a bearing as a stiff [[links]] to the ground, whose force over the frequencies `links = true` writes to response_links.csv";
    report.note(&at.span, message, hint);
}

/// Checks that harmonic amplitudes are used in a frequency response, and that a frequency response has an excitation.
pub fn check_harmonic(deck: &Deck, whole: &Deck, report: &mut Report) {
    let stages_respond = has_response(whole);
    let used = amplitudes_over_time(deck);
    let mut harmonic = deck.amplitudes.0.iter().filter(|(name, amplitude)| {
        used.contains(name.as_str())
            && amplitude.kind.as_ref().is_some_and(|kind| kind.value == AmplitudeKind::Harmonic)
    });
    let Some(kind) = deck.analysis.as_ref().and_then(|analysis| analysis.kind.as_ref()) else { return };
    match kind.value {
        AnalysisKind::FrequencyResponse if harmonic.next().is_none() && !is_synchronous(deck) => {
            let hint = "give loads, motions of supports or `base_acceleration` an `amplitude` of kind \"harmonic\": these act at their full \
                        value, and all other loads hold the static state; or give a rotor an `unbalance` in `[[loads]]`";
            report.error_with::<()>(&kind.span, "nothing excites this frequency response", hint);
        }
        AnalysisKind::Dynamic | AnalysisKind::Static if !stages_respond => {
            for (name, _) in harmonic {
                let message =
                    format!("amplitude `{}` is harmonic, and this analysis has no frequency for it", name.value);
                let hint = "over time that is kind = \"sine\", with its `frequency`; `kind = \"frequency-response\"` in `[analysis]` goes over \
                            frequencies";
                report.error_with::<()>(&name.span, message, hint);
            }
        }
        _ => {}
    }
}

/// True for a load that acts in frequency responses alone: an unbalance, or one whose amplitude is harmonic.
pub fn is_excitation(deck: &Deck, load: &Load) -> bool {
    let Some(name) = &load.amplitude else { return load.unbalance.is_some() };
    let mut named = deck.amplitudes.0.iter().filter(|(own, _)| own.value == name.value);
    named.any(|(_, amplitude)| amplitude.kind.as_ref().is_some_and(|kind| kind.value == AmplitudeKind::Harmonic))
}

/// Adds the frequencies of expected values to the computed ones.
pub fn add_expected(analysis: &mut data::Analysis, expects: &[Expect]) {
    let data::AnalysisKind::Response(response) = &mut analysis.kind else { return };
    for expect in expects {
        if let ExpectAt::Response(_, OverFrequencies::At(frequency)) = expect.at {
            response.frequencies.push(frequency);
        }
    }
    response.frequencies.sort_by(f64::total_cmp);
    response.frequencies.dedup();
    if response.extent_is_open {
        response.extent = extent(&response.frequencies);
    }
}

/// True for the amplitude of this index where it is harmonic.
pub fn is_harmonic(amplitudes: &[Amplitude], index: Option<usize>) -> bool {
    index.is_some_and(|i| amplitudes[i].harmonic_phase().is_some())
}

/// True where a stage is a frequency response.
pub fn has_response(deck: &Deck) -> bool {
    let responds = |kind: &At<StageKind>| kind.value == StageKind::FrequencyResponse;
    deck.stages.iter().any(|stage| stage.kind.as_ref().is_some_and(responds))
}

/// True for a deck with an unbalance, whose spins follow the frequency.
pub fn is_synchronous(deck: &Deck) -> bool {
    deck.loads.iter().any(|load| load.unbalance.is_some())
}
