# SPDX-License-Identifier: GPL-3.0-or-later
"""What the groups of the sheet are painted with: plain colors, glass and computed pictures."""

from array import array

COLORS = {
    "bark": (0.2, 0.1, 0.05),
    "leaf": (0.1, 0.35, 0.05),
    "young leaf": (0.25, 0.45, 0.06),
    "red": (0.6, 0.08, 0.05),
    "blue": (0.06, 0.12, 0.5),
    "green": (0.1, 0.4, 0.12),
    "yellow": (0.7, 0.5, 0.06),
    "dark": (0.03, 0.03, 0.04),
    "skin": (0.6, 0.4, 0.3),
    "paper": (0.8, 0.77, 0.68),
    "wood": (0.42, 0.24, 0.1),
    "white": (0.75, 0.75, 0.73),
    "tile": (0.45, 0.13, 0.07),
    "old tile": (0.32, 0.1, 0.06),
    "stone": (0.35, 0.34, 0.32),
    "steel": (0.3, 0.31, 0.33),
}
TEXTURES = ("twig", "brick", "stripes", "cover")


def materials(native, model) -> dict[str, int]:
    """Puts all of them into a model; their numbers by name."""
    out = {n: model.add_material(n, base_color=c, roughness=0.8) for n, c in COLORS.items()}
    out["paint"] = model.add_material("paint", base_color=(0.5, 0.03, 0.03), roughness=0.25)
    out["glass"] = model.add_material("glass", base_color=(0.9, 0.95, 0.95), transmission=1.0)
    out["pane"] = model.add_material(
        "pane", base_color=(0.15, 0.2, 0.25), alpha=0.5, alpha_mode=native.AlphaMode.BLEND
    )
    out["bulb"] = model.add_material("bulb", base_color=(0.8, 0.7, 0.5), emission=(0.8, 0.7, 0.4))
    for name in TEXTURES:
        side = 64
        pixels = array("f")
        for y in range(side):
            for x in range(side):
                pixels.extend(_texel(name, (x + 0.5) / side, (y + 0.5) / side))
        picture = model.add_picture(name, pixels=pixels, size=(side, side), linear=False)
        texture = native.texture(picture)
        fields = {"base_color_texture": texture, "base_color": model.texture_mean(texture)}
        if name == "twig":
            alpha = native.texture(picture, channel=native.Channel.ALPHA)
            mean = model.texture_mean(alpha)[0]
            fields |= {"alpha_texture": alpha, "alpha": mean, "alpha_mode": native.AlphaMode.CLIP}
        out[name] = model.add_material(name, roughness=0.8, **fields)
    return out


def _texel(name: str, u: float, v: float) -> tuple[float, float, float, float]:
    """Display-encoded; u and v in 0...1."""
    if name == "twig":  # leaves on both sides of a stem
        across, along = abs(u - 0.5), v * 5 % 1 - 0.5
        lean = along - 0.6 * (across - 0.22)
        leaf = ((across - 0.22) / 0.2) ** 2 + (lean / 0.3) ** 2 < 1
        color = (0.25, 0.5, 0.15) if across > 0.2 else (0.4, 0.6, 0.2)
        if across < 0.02:
            color = (0.35, 0.25, 0.12)
        return (*color, 1.0 if leaf or across < 0.02 else 0.0)
    if name == "brick":
        row = int(v * 8)
        x = (u * 4 + 0.5 * (row % 2)) % 1
        mortar = x < 0.08 or v * 8 % 1 < 0.15
        shade = 0.9 + 0.2 * ((row * 7 + int(u * 4 + 0.5 * (row % 2)) * 3) % 5) / 4
        return (0.75, 0.72, 0.68, 1) if mortar else (0.58 * shade, 0.3 * shade, 0.22 * shade, 1)
    if name == "stripes":
        return (0.75, 0.2, 0.2, 1) if int(u * 6) % 2 else (0.9, 0.85, 0.7, 1)
    border = min(u, v, 1 - u, 1 - v) < 0.12  # a book's cover
    title = 0.25 < u < 0.75 and 0.6 < v < 0.75
    return (0.8, 0.7, 0.3, 1) if border or title else (0.15, 0.25, 0.45, 1)
