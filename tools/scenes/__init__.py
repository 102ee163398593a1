"""Scenes that tools/scene.py films. Each is a class with the attributes and methods that camera.film() names."""

from .bouncing_ball import BouncingBall
from .golfer import Golfer
from .night_drive import NightDrive
from .rolling_ball import RollingBall
from .street import Street
from .waterfall import Waterfall
from .windmill import Windmill

# By the name that the command line takes. The first is the default.
SCENES = {scene.name: scene for scene in (RollingBall, BouncingBall, NightDrive, Waterfall, Street, Golfer, Windmill)}
