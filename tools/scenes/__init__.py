"""Scenes that tools/scene.py films. Each is a class with the attributes and methods that camera.film() names."""

from .rolling_ball import RollingBall

# By the name that the command line takes. The first is the default.
SCENES = {scene.name: scene for scene in (RollingBall,)}
