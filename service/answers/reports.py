"""The printable report of a solved job."""

from __future__ import annotations

from importlib.metadata import version

from service.answers.job_result import SolvedJob


def report_job(job: SolvedJob, most: int, built: dict[int, str]) -> tuple[str, str]:
    """Return the page, with at most ``most`` designs in full, and its content security policy.

    Parameters
    ----------
    built : dict
        Assembly of each design by number: an SVG, or the reason why there is none.
    """
    from service.render.report import POLICY, ReportedJob, report

    occasion = ReportedJob(job.id, job.kind, job.label, job.created_at, job.finished_at, version("mechsynth"))
    return report(job.load_problem(), job.load_result(), occasion, most, built), POLICY
