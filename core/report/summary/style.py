"""How a batch's page looks: on a screen by day and by night, on a narrow one, and on paper."""

LIGHT = {
    "paper": "#fbfaf8",
    "card": "#ffffff",
    "ink": "#24272b",
    "soft": "#5d646c",
    "line": "#e2dfda",
    "track": "#e6e3de",
    "link": "#0a5c96",
    "failed": "#a3281e",
    "poor": "#a24400",
    "fair": "#7a5c00",
    "good": "#00694c",
    "wash": "#fbeeec",
}
DARK = {
    "paper": "#17191c",
    "card": "#1e2125",
    "ink": "#e6e7e9",
    "soft": "#a3aab2",
    "line": "#31353b",
    "track": "#3a3f46",
    "link": "#7cbcf0",
    "failed": "#ff9d92",
    "poor": "#f5a35c",
    "fair": "#e3c04b",
    "good": "#5fcfa6",
    "wash": "#33201f",
}
"""Colors by what they are for; words never stand on anything but paper, card and wash."""


def _variables(colors: dict[str, str]) -> str:
    return "".join(f"--{name}:{color};" for name, color in colors.items())


STYLE = (
    f":root{{color-scheme:light dark;{_variables(LIGHT)}}}\n"
    f"@media screen and (prefers-color-scheme:dark){{:root{{{_variables(DARK)}}}}}\n"
    """
*{box-sizing:border-box}
html{scroll-padding-top:5.5rem}
body{margin:0 auto;padding:1.6rem 2rem 3rem;max-width:1560px;background:var(--paper);color:var(--ink);
font:15px/1.45 system-ui,-apple-system,"Segoe UI","Noto Sans",sans-serif}
h1{margin:0;font-size:1.7rem;font-weight:600;overflow-wrap:anywhere}
h2{font-size:1.1rem;font-weight:600;margin:0}
a{color:var(--link);text-decoration-thickness:1px;text-underline-offset:2px}
a:focus-visible,input:focus-visible,select:focus-visible{outline:2px solid var(--link);outline-offset:2px}
small{font-size:.84rem;color:var(--soft)}
dl{display:flex;flex-wrap:wrap;gap:.4rem 2.2rem;margin:.9rem 0 1rem}
dl div{display:flex;flex-direction:column-reverse}
dd{margin:0;font-size:1.45rem;font-weight:600;line-height:1.2;font-variant-numeric:tabular-nums}
dt{color:var(--soft);font-size:.84rem}
.first{margin:0 0 1.2rem;padding:.8rem 1.1rem .8rem 2rem;background:var(--card);border:1px solid var(--line);
border-left:4px solid var(--link);border-radius:4px;overflow-wrap:anywhere}
nav{display:flex;flex-wrap:wrap;align-items:center;gap:.3rem 1.3rem;position:sticky;top:0;z-index:2;
padding:.6rem 0;background:var(--paper);border-bottom:1px solid var(--line)}
nav a{text-decoration:none;white-space:nowrap}
nav a:hover{text-decoration:underline}
form{display:flex;flex-wrap:wrap;align-items:center;gap:.4rem 1.1rem;margin-left:auto}
form[hidden]{display:none}
label{color:var(--soft)}
input,select{font:inherit;color:var(--ink);background:var(--card);border:1px solid var(--soft);
border-radius:4px;padding:.2rem .5rem;margin-left:.3rem}
input{width:15rem;max-width:100%}
input::placeholder{color:var(--soft);opacity:1}
output{color:var(--soft);font-variant-numeric:tabular-nums}
table{width:100%;table-layout:fixed;border-collapse:collapse}
caption{position:absolute;width:1px;height:1px;overflow:hidden;clip-path:inset(50%);white-space:nowrap}
thead th{text-align:left;font-weight:400;font-size:.84rem;color:var(--soft);padding:.9rem .7rem .3rem}
thead th:nth-child(1){width:13.5%}
thead th:nth-child(2){width:31%}
thead th:nth-child(3){width:12.5%}
thead th:nth-child(5){width:13.5%}
td,tbody th{vertical-align:top;text-align:left;font-weight:400;padding:.8rem .7rem;
border-top:1px solid var(--line);overflow-wrap:anywhere}
th:first-child{padding-left:0}
td:last-child{padding-right:0}
.section th{padding:1.9rem 0 .5rem;border-top:0}
.section h2{display:inline;margin-right:.5rem}
.count{font-weight:400;color:var(--soft)}
tr[id]{background:var(--paper)}
tr[id]:target{background:var(--card);box-shadow:0 0 0 2px var(--link)}
th a{color:inherit;text-decoration:none}
th a:hover{text-decoration:underline}
th bdi{font-weight:600}
.folder{font-weight:400;color:var(--soft)}
td:nth-child(5){font-size:.9rem}
td small,th small{display:block}
.section small{display:inline}
img{display:block;width:100%;height:auto;margin-bottom:.25rem;border-radius:3px;background:var(--track)}
.strip{display:block}
svg{display:block;width:100%;height:.5rem;margin:.3rem 0 .25rem;fill:currentColor}
svg .track{fill:var(--track)}
svg .tick{fill:var(--ink)}
.share{font-size:1.2rem;font-weight:600;font-variant-numeric:tabular-nums}
td p{margin:0 0 .35rem}
td ul{margin:0;padding-left:1.1rem;font-size:.9rem;color:var(--soft)}
td .error{padding:.45rem .7rem;background:var(--wash);border-left:3px solid var(--failed);border-radius:3px}
b.failed,h2.failed,a.failed,svg.failed{color:var(--failed)}
b.poor,h2.poor,a.poor,svg.poor{color:var(--poor)}
b.fair,h2.fair,a.fair,svg.fair{color:var(--fair)}
b.good,h2.good,a.good,svg.good{color:var(--good)}
b.not-judged,b.waiting{color:var(--soft)}
#legend,#names{margin-top:2.6rem;padding-top:1.2rem;border-top:1px solid var(--line)}
#legend p{max-width:60rem;color:var(--soft);margin:.5rem 0 0}
ol{columns:17rem;column-gap:2.5rem;padding-left:2.6rem;margin:.7rem 0 0;overflow-wrap:anywhere}
li::marker{color:var(--soft);font-variant-numeric:tabular-nums}
@media screen and (max-width:960px){
body{padding:1.1rem 1rem 2rem}
html{scroll-padding-top:1rem}
nav{position:static}
form{margin-left:0}
table,tbody,tr,td,tbody th{display:block;width:auto}
thead{position:absolute;width:1px;height:1px;overflow:hidden;clip-path:inset(50%)}
tr[hidden],tbody[hidden]{display:none}
tr[id]{padding:.9rem 0;border-top:1px solid var(--line)}
tr[id] th,td{padding:.25rem 0;border:0}
td:empty{display:none}
svg{max-width:22rem}
}
@media print{
@page{size:A4 landscape;margin:10mm}
html{font-size:8.5pt}
body{max-width:none;padding:0;font-size:1rem;background:none}
nav,#names{display:none}
tr[id]{background:none}
tr[id],.first,#legend{break-inside:avoid}
.section{break-after:avoid}
.section th{padding-top:1.2rem}
thead th:nth-child(2){width:36%}
thead th:nth-child(5){width:0}
td:nth-child(5),thead th:nth-child(5){visibility:hidden;padding:0;font-size:0}
a{color:inherit;text-decoration:none}
svg,.first{print-color-adjust:exact;-webkit-print-color-adjust:exact}
td .error{background:none}
}
"""
)
