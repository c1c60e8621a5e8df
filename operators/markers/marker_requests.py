"""What is asked for where a marker is to be clicked on."""

from ..shell.footage_request import FootageRequest, side_of
from .properties import segment_title


def request_for(segment: str) -> FootageRequest:
    """The request for the marker on a segment; left and right are the performer's own."""
    title = f"Click on: {segment_title(segment)}"
    return FootageRequest(title, side_of(segment))
