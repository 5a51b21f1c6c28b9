"""Figures 3 to 5 of the paper: six cables in panels, tension and set point of robot and simulations."""

PANELS = [f"{side}_{where}_1" for side in ("inner", "outer") for where in ("top", "left", "right")]
WIDTH, HEIGHT, ACROSS, DOWN = 270, 150, 330, 200
LEFT, TOP = 60, 46
SCALE = (1, 2, 5, 10, 15, 20, 25, 30, 40, 50)


class Curve:
    """A curve in all panels: values by cable against time."""

    def __init__(self, title, colour, time_s, value_of, wide=1.2, dashes=""):
        self.title, self.colour, self.time_s, self.value_of = title, colour, time_s, value_of
        self.wide, self.dashes = wide, dashes

    def path(self, cable, span_s, top_n, left, top, row_s):
        """Returns SVG points within the span, about `row_s` apart, clipped at the top of the panel."""
        out, next_s, breaks = [], span_s[0], True
        for time_s, value in zip(self.time_s, self.value_of[cable]):
            if time_s < next_s - 1e-6 or time_s > span_s[1] + 1e-6:
                continue
            next_s = max(next_s + row_s, time_s)
            if value != value:  # NaN: no set point outside impedance control
                breaks = True
                continue
            x = left + WIDTH * (time_s - span_s[0]) / (span_s[1] - span_s[0])
            y = top + HEIGHT * (1 - min(max(value / top_n, 0), 1))
            out.append(f"{'M' if breaks else 'L' if len(out) == 1 else ''}{x:.1f} {y:.1f}")
            breaks = False
        style = f' stroke-dasharray="{self.dashes}"' if self.dashes else ""
        return f'<path d="{" ".join(out)}" stroke="{self.colour}" stroke-width="{self.wide}"{style}/>'


def top_of(curves, cable, span_s):
    """Returns the upper limit of a panel: above all tensions; set points of a gait may be far larger."""
    most = max(value for curve in curves for time_s, value in zip(curve.time_s, curve.value_of[cable])
               if span_s[0] <= time_s <= span_s[1])
    return next((end for end in SCALE if end >= 1.08 * most), 50)


def panel(number, cable, tensions, curves, span_s, row_s):
    left, top = LEFT + ACROSS * (number % 3), TOP + DOWN * (number // 3)
    top_n = top_of(tensions, cable, span_s)
    out = [f'<text x="{left + WIDTH / 2}" y="{top - 6}" text-anchor="middle">{cable.replace("_", " ")}</text>']
    for i in range(6 if top_n % 5 == 0 else 3):
        parts = 5 if top_n % 5 == 0 else 2
        value, y = top_n * i / parts, top + HEIGHT * (1 - i / parts)
        out.append(f'<path d="M{left} {y:.1f}h{WIDTH}" stroke="#ddd"/>'
                   f'<text x="{left - 6}" y="{y + 4:.1f}" text-anchor="end">{value:g}</text>')
    for i in range(6):
        time_s = span_s[0] + (span_s[1] - span_s[0]) * i / 5
        out.append(f'<text x="{left + WIDTH * i / 5:.1f}" y="{top + HEIGHT + 15}" text-anchor="middle">'
                   f"{time_s:g}</text>")
    out.append('<g fill="none" stroke-linejoin="round">')
    out += [curve.path(cable, span_s, top_n, left, top, row_s) for curve in curves]
    return out + ["</g>"]


def picture(set_point, tensions, span_s, row_s):
    """Draws all panels. `set_point` is drawn below `tensions` and does not affect their scale."""
    curves = [set_point, *tensions]
    width, height = LEFT + 3 * ACROSS - 20, TOP + 2 * DOWN + 44
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" '
           'font-family="sans-serif" font-size="11">', f'<rect width="{width}" height="{height}" fill="white"/>']
    for number, cable in enumerate(PANELS):
        out += panel(number, cable, tensions, curves, span_s, row_s)
    middle = TOP + DOWN - 25
    out.append(f'<text x="18" y="{middle}" text-anchor="middle" transform="rotate(-90 18 {middle})">tension, N</text>')
    out.append(f'<text x="{width / 2}" y="{height - 34}" text-anchor="middle">time, s</text>')
    for i, curve in enumerate(curves):
        x, y = LEFT + 240 * i, height - 14
        dashes = f' stroke-dasharray="{curve.dashes}"' if curve.dashes else ""
        out.append(f'<path d="M{x} {y - 4}h24" stroke="{curve.colour}" stroke-width="2"{dashes}/>'
                   f'<text x="{x + 30}" y="{y}">{curve.title}</text>')
    return "\n".join(out + ["</svg>", ""])
