"""check_urdf, of liburdfdom-tools: a parser that prints the tree."""

import re
import subprocess


class Robot:
    def __init__(self, case):
        command = ["check_urdf", case["urdf"]]
        done = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)
        self.text = done.stdout

    def parents(self):
        """From the indentation: each level is four columns deeper."""
        above = re.findall(r"^root Link: (\S+)", self.text, re.MULTILINE)
        found = {}
        for indent, link in re.findall(r"^( *)child\(\d+\): +(\S+)", self.text, re.M):
            depth = len(indent) // 4
            found[link] = above[depth - 1]
            above[depth:] = [link]
        return found
