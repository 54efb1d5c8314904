"""A solved job as one page for paper."""

from __future__ import annotations

from importlib.metadata import version

from service.answers.job_result import SolvedJob


def report_job(job: SolvedJob, most: int, built: dict[int, str]) -> tuple[str, str]:
    """The page, with ``most`` designs in full, and the policy that it goes out with.

    Parameters
    ----------
    built : dict
        By the number of a design: its assembly as SVG, or why there is none.
    """
    from service.render.report import POLICY, ReportedJob, report

    occasion = ReportedJob(job.id, job.kind, job.label, job.created_at, job.finished_at, version("mechsynth"))
    return report(job.statement(), job.answer(), occasion, most, built), POLICY
