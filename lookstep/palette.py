"""The colours of recording and panel, so that a thing has one colour in every view."""

RGBA = tuple[int, int, int, int]

LEFT: RGBA = (230, 85, 60, 255)
RIGHT: RGBA = (50, 120, 220, 255)
LEFT_TENTATIVE: RGBA = (244, 170, 155, 255)
RIGHT_TENTATIVE: RGBA = (150, 190, 240, 255)
LEFT_TAKEN: RGBA = (130, 60, 48, 255)
RIGHT_TAKEN: RGBA = (40, 72, 120, 255)
REGION_EDGE: RGBA = (40, 44, 52, 255)
BODY_PATH: RGBA = (250, 200, 60, 255)
SUB_GOAL: RGBA = (250, 140, 30, 255)
GOAL: RGBA = (60, 190, 90, 255)
COM: RGBA = (240, 240, 240, 255)
DCM: RGBA = (230, 60, 200, 255)
DCM_PLANNED: RGBA = (245, 170, 232, 255)
COP: RGBA = (60, 200, 170, 255)
COP_MEASURED: RGBA = (250, 200, 60, 255)
SUPPORT: RGBA = (60, 200, 170, 255)
BLOCK: RGBA = (168, 160, 148, 255)
BOX_COLORS: dict[str, RGBA] = {"pad": (120, 124, 130, 255), "base": (120, 124, 130, 255)}
GHOST: RGBA = (130, 200, 255, 255)
FORGOTTEN: RGBA = (220, 60, 50, 255)
SCAN: RGBA = (90, 96, 110, 255)
BUDGET: RGBA = (220, 70, 70, 255)
MEASURED: RGBA = (90, 170, 250, 255)

EXPANDED: RGBA = (250, 220, 90, 255)
OPENED: RGBA = (70, 160, 110, 120)
REJECTED: RGBA = (215, 70, 70, 90)

STATUS_COLORS = {
    "running": (240, 180, 50, 255),
    "success": (70, 170, 90, 255),
    "failure": (150, 88, 84, 255),
    "idle": (70, 74, 82, 255),
}

VERDICT_COLORS: dict[str, tuple[int, int, int, int]] = {
    "in time": (102, 194, 165, 255),
    "tight": (255, 217, 47, 255),
    "missed": (214, 69, 65, 255),
    "cancelled": (190, 190, 190, 255),
}

# Told apart at a glance, also side by side; after Green-Armytage's alphabet of contrasting colours, softened.
REGION_COLORS: tuple[tuple[int, int, int], ...] = (
    (102, 194, 165),
    (252, 141, 98),
    (141, 160, 203),
    (231, 138, 195),
    (166, 216, 84),
    (255, 217, 47),
    (229, 196, 148),
    (120, 180, 220),
    (190, 150, 220),
    (240, 170, 160),
    (150, 205, 190),
    (205, 205, 120),
)


_CELL = 0.15  # regions whose centres lie this near share a colour [m]


def region_color(center_xy: tuple[float, float]) -> tuple[int, int, int]:
    """A colour that a region keeps from frame to frame, because it follows from where the region lies."""
    cell = (round(center_xy[0] / _CELL), round(center_xy[1] / _CELL))
    return REGION_COLORS[(cell[0] * 7 + cell[1] * 3) % len(REGION_COLORS)]
