//! Long work, each kind in its own thread: solving, the benchmark, studies, charts and jobs.

pub(crate) mod charting;
mod export;
pub(crate) mod jobs;
pub(crate) mod latest;
pub(crate) mod measuring;
pub(crate) mod solving;
pub(crate) mod studying;
mod watching;

use std::io;

use super::jobs::{ChartRequest, Job, Measuring};
use super::solver::Request;
use super::store::WatchedFile;
use super::study::StudyRequest;

use latest::{Send, Worker};
use watching::Watcher;

/// The worker threads. The solver and the file watcher start at once, the others with their first
/// request.
pub struct Workers {
    send: Send,
    solver: Worker<Request>,
    benchmark: Option<Worker<Measuring>>,
    study: Option<Worker<StudyRequest>>,
    charts: Option<Worker<ChartRequest>>,
    jobs: [Option<Worker<Job>>; Job::KINDS],
    watcher: Watcher,
}

impl Workers {
    /// Starts the solver and the watcher of files.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub fn start(send: Send) -> io::Result<Workers> {
        Ok(Workers {
            solver: solving::start(Send::clone(&send))?,
            benchmark: None,
            study: None,
            charts: None,
            jobs: [const { None }; Job::KINDS],
            watcher: Watcher::start(Send::clone(&send))?,
            send,
        })
    }

    /// Requests a solve; replaces a waiting request.
    pub(crate) fn solve(&self, request: Request) {
        self.solver.request(request);
    }

    /// Stops the running solve.
    pub(crate) fn stop_solve(&self) {
        self.solver.stop_running();
    }

    /// Watches these files for changes by other programs.
    pub(super) fn watch(&self, files: Vec<WatchedFile>) {
        self.watcher.watch(files);
    }

    /// Requests a benchmark; replaces the running one.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub(crate) fn measure(&mut self, measuring: Measuring) -> io::Result<()> {
        let worker = match &self.benchmark {
            Some(worker) => worker,
            None => self.benchmark.insert(measuring::start(Send::clone(&self.send))?),
        };
        worker.request(measuring);
        Ok(())
    }

    /// Requests a study; replaces the running one.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub(crate) fn study(&mut self, request: StudyRequest) -> io::Result<()> {
        let worker = match &self.study {
            Some(worker) => worker,
            None => self.study.insert(studying::start(Send::clone(&self.send))?),
        };
        worker.request(request);
        Ok(())
    }

    /// Requests a chart; replaces the running one.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub fn chart(&mut self, request: ChartRequest) -> io::Result<()> {
        let worker = match &self.charts {
            Some(worker) => worker,
            None => self.charts.insert(charting::start(Send::clone(&self.send))?),
        };
        worker.request(request);
        Ok(())
    }

    pub(crate) fn stop_chart(&self) {
        self.charts.iter().for_each(Worker::stop);
    }

    pub(crate) fn stop_relief(&self) {
        self.jobs[Job::RELIEF].iter().for_each(Worker::stop);
    }

    pub(crate) fn stop_study(&self) {
        self.study.iter().for_each(Worker::stop);
    }

    pub(crate) fn stop_benchmark(&self) {
        self.benchmark.iter().for_each(Worker::stop);
    }

    /// Requests a job; replaces a waiting job of its kind.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub fn job(&mut self, job: Job) -> io::Result<()> {
        let (kind, name) = job.kind();
        let worker = match &self.jobs[kind] {
            Some(worker) => worker,
            None => self.jobs[kind].insert(jobs::start(name, Send::clone(&self.send))?),
        };
        worker.request(job);
        Ok(())
    }
}
