"""Step plot of shares of starts, 0 to 100 %: cumulative arrivals or distances."""

LEFT, TOP, WIDTH, HEIGHT = 60, 20, 640, 300


def picture(caption, ticks, guides, curves, colours, apart):
    """Draws the plot. `ticks`: evenly spaced texts below; `guides`: elements behind the curves; `curves`: by name,
    points as "x,y" in pixels; `apart`: spacing of their names in the legend [px]."""
    out = ['<svg xmlns="http://www.w3.org/2000/svg" width="740" height="400" viewBox="0 0 740 400" '
           'font-family="sans-serif" font-size="11">', '<rect width="740" height="400" fill="white"/>',
           f'<rect x="{LEFT}" y="{TOP}" width="{WIDTH}" height="{HEIGHT}" fill="none" stroke="#999"/>']
    for i, tick in enumerate(ticks):
        x = LEFT + WIDTH * i / (len(ticks) - 1)
        out.append(f'<text x="{x:.1f}" y="{TOP + HEIGHT + 16}" text-anchor="middle">{tick}</text>')
    for i in range(5):
        y = TOP + HEIGHT * (1 - i / 4)
        out.append(f'<text x="{LEFT - 6}" y="{y + 4:.1f}" text-anchor="end">{25 * i} %</text>')
    out += guides
    out.append(f'<text x="{LEFT + WIDTH / 2}" y="{TOP + HEIGHT + 34}" text-anchor="middle">{caption}</text>')
    for i, ((name, points), colour) in enumerate(zip(curves.items(), colours)):
        out.append(f'<polyline points="{" ".join(points)}" fill="none" stroke="{colour}" stroke-width="1.6"/>')
        out.append(f'<rect x="{LEFT + apart * i}" y="375" width="18" height="8" fill="{colour}"/>')
        out.append(f'<text x="{LEFT + 24 + apart * i}" y="383">{name}</text>')
    return "\n".join(out + ["</svg>", ""])
