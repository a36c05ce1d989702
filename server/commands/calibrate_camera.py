"""`pivotrig calibrate board | lens`: the board to print, and the lens from views of it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from server.camera_sections import BoardSection, CameraSection
from server.commands.bench import JsonOption, SaveOption, explained
from server.commands.calibration_result import saved_or_shown, show
from server.commands.outcome import FAILED, RigOption, fail, read_rig_file

if TYPE_CHECKING:
    from vision.calibration.board import Image, Sighting
    from vision.calibration.lens import LensFit


ImagesOption = Annotated[
    Path | None,
    typer.Option("--images", help="Pictures of the board in a folder, instead of the live camera."),
]


def board(
    columns: Annotated[int | None, typer.Option(min=4, max=40, help="Squares across.")] = None,
    rows: Annotated[int | None, typer.Option(min=4, max=40, help="Squares down.")] = None,
    square: Annotated[float | None, typer.Option("--square-mm", help="Side of a square, mm.")] = None,
    out: Annotated[Path, typer.Option(help="The PDF to write.")] = Path("board.pdf"),
    save: Annotated[
        bool, typer.Option("--save", help="Make it the board that the rig file describes.")
    ] = False,
    rig: RigOption = None,
    as_json: JsonOption = False,
) -> None:
    """Write the board to print: a PDF at true scale. Print it at 100 %, and glue it to something flat."""
    from server.calibration.board_sheet import board_pdf, paper_for
    from server.calibration.optics import board_of

    given = {"columns": columns, "rows": rows, "square_mm": square}
    chosen = {name: value for name, value in given.items() if value is not None}
    camera = read_rig_file(rig).camera
    with explained():
        section = BoardSection.model_validate({**camera.board.model_dump(), **chosen})
        printed = board_of(CameraSection(board=section))
        _write(out, board_pdf(printed))
    words = f"{out}: {section.columns} x {section.rows} squares of {section.square_mm:g} mm on {paper_for(printed)[0]}"
    result = {"file": str(out), "paper": paper_for(printed)[0], **section.model_dump()}
    changes = {"camera": {"board": section.model_dump()}}
    where = saved_or_shown(rig, changes, save) if save or section != camera.board else "print it at 100 %"
    show(result, [words], where, as_json)


def _write(path: Path, content: bytes) -> None:
    try:
        path.write_bytes(content)
    except OSError as error:
        raise fail(f"cannot write {path}: {error.strerror or error}", FAILED) from error


def lens(
    images: ImagesOption = None, save: SaveOption = False, rig: RigOption = None, as_json: JsonOption = False
) -> None:
    """Find the lens from views of the printed board: hold it under the camera, and follow the hints."""
    from server.api.calibration_answers import pending_lens_json
    from server.calibration.optics import lens_section, today
    from server.commands.camera_bench import opened_camera, watching
    from vision.calibration.lens import solve_lens

    with (
        opened_camera(read_rig_file(rig)) as bench,
        watching("lay the board flat under the camera") as status,
    ):
        identity = bench.machine.camera.identity
        views = _of_folder(bench.finder.find, images) if images is not None else bench.gather(status).taken
        status.update("solving the lens")
        fit = solve_lens(views)
    changes = {"camera": {"lens": lens_section(fit, identity, today()), "plane": None}}
    result = {**pending_lens_json(fit), "identity": identity}
    show(result, _lens_words(fit), saved_or_shown(rig, changes, save), as_json)


def _of_folder(find: Callable[[Image], Sighting | None], folder: Path) -> list[Sighting]:
    """The board in each picture in which it is seen."""
    from vision.sources.image_folder import ImageFolder

    film = ImageFolder(folder)
    found = []
    while film.advance() is not None:
        picture = film.picture()
        sighting = None if picture is None else find(picture)
        if sighting is not None:
            found.append(sighting)
    return found


def _lens_words(fit: LensFit) -> list[str]:
    one = fit.lens
    return [
        f"{fit.views} views at {one.size[0]} x {one.size[1]} px, residual {fit.residual:.3f} px",
        f"focal length {one.fx:.2f} and {one.fy:.2f} px, middle ({one.cx:.2f}, {one.cy:.2f}) px",
        "distortion " + ", ".join(f"{value:.5f}" for value in one.distortion),
        f"what the views leave open shifts a place in the picture by {one.error:.3f} px",
        *fit.dropped,
        "calibrate the plane next: a plane that was calibrated before belongs to the old lens",
    ]
