"""What callers hand over is data: nothing of it runs, and it cannot grow."""

from __future__ import annotations

import contextlib
import dataclasses
import json
import threading
import zipfile
from pathlib import Path

import pytest
import yaml

from zygopin import Finger, Foot, FootModel, load_atlas, template, to_urdf
from zygopin.errors import DescriptionError, FileError, ParameterError, ZygopinError
from zygopin.files import read_text
from zygopin.plain_yaml import MOST
from zygopin.presets import read_parameters

ONE_LINE = 400
"""Characters that are as good as one line: a message is not a dump."""


# YAML ------------------------------------------------------------------------------

LEVELS = 12
LAUGHS = "sources:\n  a0: &a0 [x, x]\n" + "".join(
    f"  a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]\n" for i in range(1, LEVELS)
)
MERGES = "sources:\n  a0: &a0 {k: v}\n" + "".join(
    f"  a{i}: &a{i} {{<<: [{', '.join([f'*a{i - 1}'] * 10)}]}}\n"
    for i in range(1, LEVELS)
)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (LAUGHS, "an alias repeats this list or mapping: write it out"),
        (LAUGHS + f"rho: *a{LEVELS - 1}\n", "write it out"),
        (MERGES, "write it out"),
        ("rho: &a [*a]", "write it out"),
        ("fingers: [&a {name: *a, phalanges: 1, azimuth: 0}]", "write it out"),
        (f"rho: {'[' * 60000}", "lists or mappings are nested too deep"),
        (f"rho: {'{a: ' * 900}1{'}' * 900}", "nested too deep"),
        (f"rho: {'[' * 300}1{']' * 300}", "rho = [[[[...]]]] is not a number"),
        (f"rho: {':'.join(['59'] * 10**5)}", f"at most {MOST} are read"),
        (f"rho: {'9' * 6000}", "conversion: value has 6000 digits: mend the syntax"),
        ("rho: 1.5\nname: a\nrho: 2", "'rho' is there twice"),
        ("fingers: [{name: a, name: b}]", "'name' is there twice"),
        (f"rho: 0x{'f' * 6000}", "rho = an integer of 24000 bits is not a number"),
        (f"? 0x{'f' * 6000}\n: 1", "field of foot an integer of 24000 bits"),
        ("rho: !!set {b, a, c}", "rho = {'a', 'b', 'c'} is not a number"),
    ],
)
def test_yaml_that_grows_or_goes_deep_is_refused_in_one_line(text, words, tmp_path):
    file = tmp_path / "foot.yaml"
    file.write_text(text)
    with pytest.raises(FileError) as caught:
        Foot.load(file)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < ONE_LINE + len(str(file))


def test_an_alias_of_a_number_is_that_number(tmp_path):
    file = tmp_path / "foot.yaml"
    file.write_text("scale: &a 0.02\nthickness: 0.001\nomega: *a\n")
    assert Foot.load(file).omega == 0.02


def payloads(marker):
    """Texts that make a file where they are run: Python, YAML, xacro, a shell."""
    code = f"__import__('os').system('touch {marker}')"
    return [
        code,
        f"${{{code}}}",
        f"$(eval {code})",
        f"$(arg foot) ${{xacro.load_yaml('{marker}')}}",
        f"$(touch {marker})",
        f"'; touch {marker}; '",
        f"!!python/object/apply:os.system ['touch {marker}']",
        f"!!python/object/new:os.system ['touch {marker}']",
        f"!degrees {code}",
        f"!radians ${{{code}}}",
    ]


FIELDS = ("name", "rho", "omega", "splay", "scale", "thickness", "density", "fingers")
TOES = ("name", "phalanges", "azimuth", "orientation", "reversed_azimuth")


def test_no_text_in_a_foot_s_file_is_ever_run(tmp_path):
    marker, file = tmp_path / "marker", tmp_path / "foot.yaml"
    plain = {"name": "toe", "phalanges": 2, "azimuth": 0.0}
    for text in payloads(marker):
        given = text if text.startswith("!") else json.dumps(text)
        toes = [
            ", ".join(f"{key}: {value}" for key, value in {**plain, toe: given}.items())
            for toe in TOES
        ]
        fields = [f"{field}: {given}\n" for field in FIELDS]
        for content in (
            *fields,
            *(f"fingers: [{{{toe}}}]\n" for toe in toes),
            f"{given}: 1\n",
            f"? {given}\n: 1\n",
            f"{given}\n",
        ):
            file.write_text(content)
            with pytest.raises(FileError) as caught:
                to_urdf(Foot.load(file))
            assert "\n" not in str(caught.value)
    assert not marker.exists()


def test_no_option_s_text_is_ever_run(run, tmp_path):
    marker = tmp_path / "marker"
    own = tmp_path / "out"
    perch = ("perch", "--radius-mm", "8")
    for text in payloads(marker):
        for arguments in (
            *(
                ("urdf", "-o", str(own), f"--{option}={text}")
                for option in ("rho", "preset", "foot")
            ),
            ("presets", text),
            ("check", "--radius-mm=8", "--height-mm=-20", f"--controls={text}"),
            ("sweep", "--radius-mm=8", f"--scheduler={text}"),
            ("sweep", "--radius-mm=8", f"--phalanges={text}", "--scheduler=sync"),
            ("branches", f"--pair={text}", "--levels=2"),
            (*perch, f"--yaw-deg={text}"),
        ):
            assert run(*arguments).returncode == 2, arguments
    assert not own.exists()
    assert not marker.exists()


def test_no_name_or_number_that_xacro_would_evaluate_makes_a_foot(tmp_path):
    marker = tmp_path / "marker"
    for text in payloads(marker):
        for field in FIELDS:
            with pytest.raises(ZygopinError):
                Foot(**{field: text})
        for toe in TOES:
            with pytest.raises(ParameterError):
                dataclasses.replace(Finger("toe", 1, 0.0), **{toe: text})
    assert not marker.exists()


def test_xacro_s_tags_are_refused_even_while_xacro_has_taught_them(tmp_path):
    file = tmp_path / "foot.yaml"
    file.write_text("rho: !degrees 2*30\n")
    yaml.SafeLoader.add_constructor("!degrees", lambda *_: 1.5)
    try:
        assert yaml.safe_load(file.read_text()) == {"rho": 1.5}
        with pytest.raises(FileError, match="not YAML: could not determine"):
            read_parameters(file)
    finally:
        del yaml.SafeLoader.yaml_constructors["!degrees"]


def test_a_thread_that_reads_yaml_meets_no_tag_of_xacro_s(tmp_path):
    file = tmp_path / "foot.yaml"
    file.write_text("rho: !degrees 2*30\n")
    done, read = threading.Event(), []

    def reading():
        while not done.is_set():
            with contextlib.suppress(FileError):
                read.append(read_parameters(file))

    thread = threading.Thread(target=reading)
    thread.start()
    for rho in (1.21, 1.22, 1.23):
        template.expand(Foot(rho=rho))
    done.set()
    thread.join()
    assert read == []


@pytest.mark.parametrize(
    "name", ["it's", 'a "b"', "ü ζ", "[1, 2]", "{a}", "<&>", "2*3"]
)
def test_a_temporary_folder_of_any_name_is_only_a_name(name, tmp_path, monkeypatch):
    foot = Foot(rho=1.3)
    expected = template.expand(foot)
    (tmp_path / name).mkdir()
    monkeypatch.setattr(template, "gettempdir", lambda: str(tmp_path / name))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / name))
    assert template.expand(foot) == expected
    assert list((tmp_path / name).iterdir()) == []


def test_a_temporary_folder_that_xacro_would_evaluate_is_refused(tmp_path, monkeypatch):
    marker = tmp_path / "marker"
    folder = tmp_path / f"${{open('{str(marker).replace('/', '∕')}', 'w')}}"
    folder.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(folder))
    with pytest.raises(DescriptionError, match=r"\$ in its name.*: set TMPDIR"):
        template.expand(Foot(rho=1.3))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "none"))
    with pytest.raises(DescriptionError, match="no temporary file can be written"):
        template.expand(Foot(rho=1.3))
    assert not marker.exists()


# Other files that are read ---------------------------------------------------------


def test_a_text_that_never_ends_is_not_waited_for():
    with pytest.raises(
        FileError, match="more than 67108864 bytes: name a smaller file"
    ):
        read_text("/dev/zero")


@pytest.mark.parametrize("text", ["[" * 10**5, f"[{'9' * 5000}]", '{"a":' * 10**5])
def test_controls_that_go_deep_or_are_long_are_one_line(text, run, tmp_path):
    file = tmp_path / "controls.json"
    file.write_text(text)
    found = run("check", "--radius-mm=8", "--height-mm=-20", f"--controls={file}")
    assert (found.returncode, found.stdout) == (2, "")
    assert len(found.stderr.splitlines()) == 1


def array_header(shape, dtype):
    """What a NumPy file begins with."""
    head = f"{{'descr': {dtype!r}, 'fortran_order': False, 'shape': {shape}, }}"
    return b"\x93NUMPY\x01\x00" + len(head).to_bytes(2, "little") + head.encode()


@pytest.mark.parametrize(
    "content",
    [
        array_header((10**14,), "<f8"),
        array_header((1,), "|O") + b"cos\nsystem\n(S'touch marker'\ntR.",
        array_header("__import__('os').system('touch marker')", "<f8"),
        b"[" * 10**5,
    ],
)
def test_an_atlas_that_lies_is_one_line_and_runs_nothing(
    content, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    with zipfile.ZipFile("a.npz", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("heights.npy", content)
    with pytest.raises(FileError, match=r"a\.npz: is no atlas: name a file"):
        load_atlas("a.npz")
    assert not Path("marker").exists()


LAUGHING_XML = """<?xml version="1.0"?><!DOCTYPE robot [<!ENTITY a0 "ha">{}]>
<robot name="&a9;"/>""".format(
    "".join(f'<!ENTITY a{i} "{f"&a{i - 1};" * 10}">' for i in range(1, 10))
)
READING_XML = """<?xml version="1.0"?>
<!DOCTYPE robot [<!ENTITY a SYSTEM "file:///etc/passwd">]><robot name="x">&a;</robot>"""


@pytest.mark.parametrize("text", [LAUGHING_XML, READING_XML])
def test_a_urdf_s_entities_are_not_expanded(text):
    with pytest.raises(DescriptionError, match="the URDF") as caught:
        FootModel(Foot.preset("parrot"), text)
    assert len(str(caught.value)) < ONE_LINE
