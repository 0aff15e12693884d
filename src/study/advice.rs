//! The outcome of running a deck with each part rigid and reduced in turn, in words and as rigidify.csv.

use super::cells::{field, maybe, seconds};
use super::columns::columns;
use super::run::{RunStatus, StudyRun};
use model::study::Quantity;

/// Largest time of a form over that of the deck to be advised: two runs of one deck differ by a few per cent.
const MOST_TIME: f64 = 0.95;

/// A beam, bar or shell that deforms.
#[derive(Debug, Clone)]
pub struct AdvisedPart {
    /// The kind of part: `beam`, `bar` or `shell`.
    pub kind: &'static str,
    /// The name of the part.
    pub name: String,
    /// Its form in the run, as an entry of the deck: `rigid = true`, or `reduced = 20`.
    pub form: String,
    /// The largest elastic energy of this part over the largest elastic energy of all parts together, each at any time. Like the next, it
    /// is `None` if the original deck did not reach its end.
    pub peak_share: Option<f64>,
    /// The share of this part in the elastic energy summed over all times.
    pub mean_share: Option<f64>,
    /// The run with this part in this form; a reason in words where there can be none.
    pub run: Result<StudyRun, String>,
}

/// The share of each part of a deck in the energy, and the error and the saved time of a run with that part rigid or reduced.
pub struct StudyAdvice {
    /// The quantities that errors are measured on.
    pub quantities: Vec<Quantity>,
    /// The number of intervals between the times of comparison.
    pub samples: usize,
    /// The run of the original deck.
    pub base: StudyRun,
    /// The parts, in the order of the deck, each in its forms.
    pub parts: Vec<AdvisedPart>,
    /// True where a signal has ended it before all runs were done.
    pub stopped: bool,
}

impl StudyAdvice {
    /// A table for standard output, sorted by the error, smallest first; then what to choose for the error `wanted`.
    pub fn text(&self, wanted: Option<f64>) -> String {
        let head = ["part", "kind", "form", "energy, most", "mean", "error", "loop s", "saved", "unknowns", "status"];
        let percent = |part: Option<f64>| match part.map(|part| 100.0 * part) {
            None => String::new(),
            Some(0.0) => "0 %".to_owned(),
            Some(p) if p.abs() < 0.1 => format!("{p:.0e} %"),
            Some(p) => format!("{p:.1} %"),
        };
        let base = &self.base;
        let mut rows = vec![head.map(String::from).to_vec()];
        let empty = String::new;
        let (loop_s, unknowns) = (seconds(base.loop_s), base.measured.unknowns.to_string());
        let status = if base.status == RunStatus::Done {
            "done".into()
        } else {
            format!("{}: {}", base.status.word(), base.reason)
        };
        rows.push(vec![
            "(as it is)".into(),
            empty(),
            empty(),
            empty(),
            empty(),
            empty(),
            loop_s,
            empty(),
            unknowns,
            status,
        ]);
        let mut parts: Vec<&AdvisedPart> = self.parts.iter().collect();
        let error = |part: &AdvisedPart| part.run.as_ref().ok().and_then(|run| run.error).unwrap_or(f64::INFINITY);
        let share = |part: &AdvisedPart| part.peak_share.unwrap_or(0.0);
        parts.sort_by(|a, b| error(a).total_cmp(&error(b)).then(share(a).total_cmp(&share(b))));
        for part in parts {
            let shares = [part.peak_share, part.mean_share].map(percent);
            let mut row = vec![part.name.clone(), part.kind.to_owned(), part.form.clone()];
            row.extend(shares);
            match &part.run {
                Ok(run) if run.status == RunStatus::Done => row.extend([
                    run.error.map_or(empty(), |error| format!("{error:.2e}")),
                    seconds(run.loop_s),
                    percent((base.status == RunStatus::Done).then(|| 1.0 - run.loop_s / base.loop_s)),
                    run.measured.unknowns.to_string(),
                    "done".into(),
                ]),
                Ok(run) => {
                    row.extend([empty(), empty(), empty(), empty(), format!("{}: {}", run.status.word(), run.reason)])
                }
                Err(reason) => row.extend([empty(), empty(), empty(), empty(), reason.clone()]),
            }
            rows.push(row);
        }
        let (samples, count) = (self.samples + 1, self.quantities.len());
        let what = if count == 1 { "quantity" } else { "quantities" };
        let advice = wanted.map(|wanted| self.advice(wanted)).unwrap_or_default();
        format!("{}\nerror: against the unchanged deck, {count} {what} at {samples} times\n{advice}", columns(&rows, 2))
    }

    /// The form of each part that takes the least time with this error. A part stays as it is where no form is clearly faster.
    fn advice(&self, wanted: f64) -> String {
        let mut out = format!("\nfor an error of {wanted:.0e} of each part alone; errors of several parts add up\n");
        for parts in self.parts.chunk_by(|a, b| (a.kind, &a.name) == (b.kind, &b.name)) {
            let fits = |part: &&AdvisedPart| {
                let run = part.run.as_ref().ok().filter(|run| run.error.is_some_and(|error| error <= wanted));
                run.is_some_and(|run| run.loop_s < MOST_TIME * self.base.loop_s)
            };
            let time = |part: &AdvisedPart| part.run.as_ref().map_or(f64::INFINITY, |run| run.loop_s);
            let least = parts.iter().filter(fits).min_by(|a, b| time(a).total_cmp(&time(b)));
            let choice = match least.and_then(|part| Some((part, part.run.as_ref().ok()?))) {
                None if !parts.iter().any(|part| part.run.as_ref().is_ok_and(|run| run.error.is_some())) => {
                    "no other form was measured".to_owned()
                }
                None => "as it is".to_owned(),
                Some((part, run)) => {
                    let (error, time) = (run.error.unwrap_or_default(), run.loop_s / self.base.loop_s);
                    format!("{}, error {error:.1e}, {time:.2} of the time", part.form)
                }
            };
            out += &format!("{} `{}`: {choice}\n", parts[0].kind, parts[0].name);
        }
        out
    }

    /// The text of rigidify.csv.
    pub fn table(&self) -> String {
        let head = "kind,part,form,peak_share,mean_share,status,error,loop_s,process_s,repeats,unknowns,folder,reason";
        let mut out = head.to_owned();
        self.quantities
            .iter()
            .for_each(|quantity| out += &format!(",{}", field(&format!("error:{}", quantity.word()))));
        out.push('\n');
        let mut row = |[kind, name, form]: [&str; 3], shares: [Option<f64>; 2], run: Result<&StudyRun, &str>| {
            let [peak, mean] = shares.map(maybe);
            out += &format!("{kind},{},{form},{peak},{mean}", field(name));
            match run {
                Ok(run) => {
                    let [loop_s, process_s] = [run.loop_s, run.process_s].map(|s| maybe(Some(s)));
                    out += &format!(",{},{},{loop_s},{process_s}", run.status.word(), maybe(run.error));
                    out += &format!(
                        ",{},{},{},{}",
                        run.times.len(),
                        run.measured.unknowns,
                        run.folder,
                        field(&run.reason)
                    );
                }
                Err(reason) => out += &format!(",none,,,,,,,{}", field(reason)),
            }
            for i in 0..self.quantities.len() {
                let error = run.ok().and_then(|run| run.errors.get(i).copied());
                out += &format!(",{}", maybe(error));
            }
            out.push('\n');
        };
        row(["all", "", ""], [None, None], Ok(&self.base));
        for part in &self.parts {
            let shares = [part.peak_share, part.mean_share];
            row([part.kind, &part.name, &part.form], shares, part.run.as_ref().map_err(String::as_str));
        }
        out
    }
}
