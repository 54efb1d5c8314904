"""The language of an answer: the best of those that ``Accept-Language`` allows (RFC 9110, 12.5.4)."""

from __future__ import annotations

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from kinematics.message import LANGUAGES, SOURCE_LANGUAGE, use_language

MAX_RANGES = 50
"""Maximum number of language ranges that are read; browsers send fewer than ten."""

_TEXT_TYPES = ("application/json", "application/problem+json", "text/event-stream")


def choose_language(header: str) -> str:
    """Return the available language that a value of ``Accept-Language`` prefers, or the default language.

    >>> choose_language("fr, de-AT;q=0.8, en;q=0.5"), choose_language("en, de;q=0.9"), choose_language("")
    ('de', 'en', 'en')
    """
    qualities: dict[str, float] = {}
    for entry in header.split(",")[:MAX_RANGES]:
        tag, _, parameter = entry.partition(";")
        language = tag.strip().lower().partition("-")[0]
        name, _, value = parameter.replace(" ", "").partition("=")
        try:
            quality = float(value) if name.lower() == "q" else 1.0
        except ValueError:
            continue
        # Of several ranges for a language, such as de-AT and de, the best counts.
        qualities[language] = max(quality, qualities.get(language, 0.0))
    remaining = qualities.get("*", 0.0)
    accepted = [language for language in LANGUAGES if qualities.get(language, remaining) > 0.0]
    # Of equal qualities the first in the order of LANGUAGES is chosen.
    return max(accepted, key=lambda language: qualities.get(language, remaining), default=SOURCE_LANGUAGE)


class AnswerInLanguage:
    """Middleware that composes the messages of each answer in the language that its client prefers."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, and name the language in the answer if it contains text for people."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        language = choose_language(", ".join(Headers(scope=scope).getlist("accept-language")))

        async def send_with_language(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(raw=message["headers"])
                if headers.get("content-type", "").startswith(_TEXT_TYPES):
                    headers.add_vary_header("Accept-Language")
                    headers["Content-Language"] = language
            await send(message)

        with use_language(language):
            await self._app(scope, receive, send_with_language)
