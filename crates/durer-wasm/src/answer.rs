//! Requests and their answers.

use crate::input::InputData;
use crate::runs::Runs;
use crate::{lessons, runs};
use serde::Deserialize;
use serde_json::json;

/// Answer to a request.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Answer {
    /// A JSON text.
    Json(String),
    /// Bytes of a file.
    Bytes(Vec<u8>),
    /// A JSON text whose `error` says what is wrong.
    Error(String),
}

/// Engine that answers requests, and keeps the runs that they refer to.
#[derive(Debug, Default)]
pub struct Engine {
    runs: Runs,
}

/// Failure of a request, in words.
pub(crate) type Failure = String;

/// A request without the bytes that may follow it.
#[derive(Debug, Deserialize)]
#[serde(tag = "do", rename_all = "kebab-case", deny_unknown_fields)]
enum Request {
    Lessons,
    Run(Box<RunRequest>),
    Frame(FrameRequest),
    Captions {
        handle: u32,
        first: usize,
        count: usize,
        language: LanguageCode,
    },
    Tikz(FrameRequest),
    Drop {
        handle: u32,
    },
    #[cfg(feature = "files")]
    Methods,
    #[cfg(feature = "files")]
    Formula(crate::files::FormulaRequest),
    #[cfg(feature = "files")]
    Read(crate::files::ReadRequest),
    #[cfg(feature = "files")]
    Render(crate::files::RenderRequest),
}

/// Request for a run.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RunRequest {
    /// Name of the lesson.
    pub name: String,
    /// Example or data.
    pub input: InputData,
    /// Name of an operation on two polygons; the default one if empty.
    #[serde(default)]
    pub operation: String,
    /// Name of a fill rule; the default one if empty.
    #[serde(default)]
    pub rule: String,
    /// Number of a fault of the lesson's program; none for the library's own function.
    #[serde(default)]
    pub fault: Option<usize>,
    /// The most steps.
    pub cap: usize,
    /// True to list the operations and rules that change the run.
    #[serde(default)]
    pub choices: bool,
}

/// Request for one frame.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FrameRequest {
    /// Number of the run.
    pub handle: u32,
    /// Step, counted from 0.
    pub step: usize,
    /// Language of texts.
    pub language: LanguageCode,
    /// Longer side of the drawing in pixels.
    #[serde(default = "longest")]
    pub longest: f64,
}

fn longest() -> f64 {
    420.0
}

/// Language by its code.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum LanguageCode {
    /// English.
    En,
    /// German.
    De,
}

impl From<LanguageCode> for durer::explain::Language {
    fn from(code: LanguageCode) -> Self {
        match code {
            LanguageCode::En => Self::English,
            LanguageCode::De => Self::German,
        }
    }
}

impl Engine {
    /// Answers a request: JSON, and for some a zero byte with the bytes of a file after it.
    pub fn answer(&mut self, request: &[u8]) -> Answer {
        let end = request.iter().position(|&byte| byte == 0).unwrap_or(request.len());
        let (text, rest) = request.split_at(end);
        let file = rest.get(1..).unwrap_or_default();
        let parsed = serde_json::from_slice(text).map_err(|e| format!("the request: {e}"));
        match parsed.and_then(|request| self.done(request, file)) {
            Ok(answer) => answer,
            Err(failure) => Answer::Error(json!({ "error": failure }).to_string()),
        }
    }

    fn done(&mut self, request: Request, file: &[u8]) -> Result<Answer, Failure> {
        let text = match request {
            Request::Lessons => lessons::list().to_string(),
            Request::Run(request) => self.runs.start(*request)?.to_string(),
            Request::Frame(request) => runs::frame(self.runs.of(request.handle)?, &request)?,
            Request::Captions { handle, first, count, language } => {
                let run = self.runs.of(handle)?;
                runs::captions(run, first, count, language.into()).to_string()
            }
            Request::Tikz(request) => {
                let frame = runs::made(self.runs.of(request.handle)?, request.step)?;
                json!({ "tikz": crate::tikz::tikz(&frame, request.language.into()) }).to_string()
            }
            Request::Drop { handle } => {
                self.runs.drop(handle);
                "{}".to_owned()
            }
            #[cfg(feature = "files")]
            Request::Methods => crate::files::methods().to_string(),
            #[cfg(feature = "files")]
            Request::Formula(request) => crate::files::formula(&request)?.to_string(),
            #[cfg(feature = "files")]
            Request::Read(request) => crate::files::read(&request, file)?.to_string(),
            #[cfg(feature = "files")]
            Request::Render(request) => {
                return crate::files::render(&request, file).map(Answer::Bytes);
            }
        };
        let _ = file;
        Ok(Answer::Json(text))
    }
}
