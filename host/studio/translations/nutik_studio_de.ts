<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="de_DE" sourcelanguage="en">
<context>
    <name>nutik::studio</name>
    <message>
        <source>Look</source>
        <translation>Betrachten</translation>
    </message>
    <message>
        <source>A click shows the light of a pixel; dragging pans</source>
        <translation>Ein Klick zeigt das Licht eines Pixels; Ziehen verschiebt</translation>
    </message>
    <message>
        <source>Brush</source>
        <translation>Pinsel</translation>
    </message>
    <message>
        <source>Paints the selected region; Alt erases</source>
        <translation>Malt die ausgewählte Region; Alt löscht</translation>
    </message>
    <message>
        <source>Rectangle</source>
        <translation>Rechteck</translation>
    </message>
    <message>
        <source>Shift: a square; Alt erases</source>
        <translation>Umschalt: ein Quadrat; Alt löscht</translation>
    </message>
    <message>
        <source>Ellipse</source>
        <translation>Ellipse</translation>
    </message>
    <message>
        <source>Shift: a circle; Alt erases</source>
        <translation>Umschalt: ein Kreis; Alt löscht</translation>
    </message>
    <message>
        <source>Polygon</source>
        <translation>Polygon</translation>
    </message>
    <message>
        <source>Corners by clicks; a double click or Enter closes it</source>
        <translation>Ecken durch Klicks; Doppelklick oder Eingabe schließt es</translation>
    </message>
    <message>
        <source>Wand</source>
        <translation>Zauberstab</translation>
    </message>
    <message>
        <source>Pixels that look like the one clicked and hang together with it</source>
        <translation>Pixel, die dem angeklickten gleichen und mit ihm zusammenhängen</translation>
    </message>
    <message>
        <source>Picture: wheel, middle button</source>
        <translation>Bild: Mausrad, mittlere Taste</translation>
    </message>
    <message>
        <source>zooms to the pointer, pans</source>
        <translation>zoomt zum Zeiger, verschiebt</translation>
    </message>
    <message>
        <source>Space, Escape</source>
        <translation>Leertaste, Esc</translation>
    </message>
    <message>
        <source>plays the interval as a film and stops it; stops it</source>
        <translation>spielt das Intervall als Film und hält ihn an; hält ihn an</translation>
    </message>
    <message>
        <source>Picture: Return</source>
        <translation>Bild: Eingabe</translation>
    </message>
    <message>
        <source>takes a pixel, which arrows then move</source>
        <translation>wählt einen Pixel, den dann Pfeile bewegen</translation>
    </message>
    <message>
        <source>Picture with a tool: arrows, Space, Backspace</source>
        <translation>Bild mit Werkzeug: Pfeile, Leertaste, Rücktaste</translation>
    </message>
    <message>
        <source>move the pointer; begin and end a stroke, one that erases</source>
        <translation>bewegen den Zeiger; beginnen und beenden einen Strich, einen löschenden</translation>
    </message>
    <message>
        <source>Alt with a tool</source>
        <translation>Alt mit Werkzeug</translation>
    </message>
    <message>
        <source>erases</source>
        <translation>löscht</translation>
    </message>
    <message>
        <source>H, M, A, held</source>
        <translation>H, M, A, gehalten</translation>
    </message>
    <message>
        <source>hides outlines; magnifies round the pointer, with codes; shows snapshot A</source>
        <translation>verbirgt Umrisse; vergrößert um den Zeiger, mit Codes; zeigt Schnappschuss A</translation>
    </message>
    <message>
        <source>Time: wheel, Shift and wheel, F</source>
        <translation>Zeit: Mausrad, Umschalt und Mausrad, F</translation>
    </message>
    <message>
        <source>zooms, pans, shows all</source>
        <translation>zoomt, verschiebt, zeigt alles</translation>
    </message>
    <message>
        <source>Strip: Left, Right, Up, Down</source>
        <translation>Leiste: links, rechts, auf, ab</translation>
    </message>
    <message>
        <source>the interval earlier and later, longer and shorter, by a sample</source>
        <translation>das Intervall früher und später, länger und kürzer, um ein Sample</translation>
    </message>
    <message>
        <source>Strip: I, O, X, Z</source>
        <translation>Leiste: I, O, X, Z</translation>
    </message>
    <message>
        <source>In and Out at its ends; exposes between them; shows what lies there</source>
        <translation>In und Out an seine Enden; belichtet dazwischen; zeigt, was dort liegt</translation>
    </message>
    <message>
        <source>Curve: click, right click</source>
        <translation>Kurve: Klick, Rechtsklick</translation>
    </message>
    <message>
        <source>adds a point, takes it away</source>
        <translation>fügt einen Punkt hinzu, entfernt ihn</translation>
    </message>
    <message>
        <source>Curve: Insert, Delete, Return</source>
        <translation>Kurve: Einfg, Entf, Eingabe</translation>
    </message>
    <message>
        <source>the same, and types numbers; arrows move a point</source>
        <translation>dasselbe, und Eintippen von Zahlen; Pfeile bewegen einen Punkt</translation>
    </message>
    <message>
        <source>Shift, Ctrl while dragging</source>
        <translation>Umschalt, Strg beim Ziehen</translation>
    </message>
    <message>
        <source>a tenth as fast; not drawn to samples</source>
        <translation>ein Zehntel so schnell; ohne Einrasten an Samples</translation>
    </message>
    <message>
        <source>Escape</source>
        <translation>Esc</translation>
    </message>
    <message>
        <source>takes back what is not finished, closes a message</source>
        <translation>nimmt Unfertiges zurück, schließt eine Meldung</translation>
    </message>
</context>
<context>
    <name>nutik::studio::Canvas</name>
    <message>
        <source>Picture</source>
        <translation>Bild</translation>
    </message>
    <message>
        <source>The exposure. Plus and minus zoom, Ctrl+1 shows pixel for pixel, Ctrl+0 all of it; arrow keys pan. Return takes a pixel, which arrow keys then move. With a tool arrow keys move the pointer, Space begins and ends a stroke, Backspace one that erases.</source>
        <translation>Die Belichtung. Plus und Minus zoomen, Strg+1 zeigt Pixel für Pixel, Strg+0 das ganze Bild; Pfeiltasten verschieben es. Die Eingabetaste wählt einen Pixel, den dann Pfeiltasten bewegen. Mit einem Werkzeug bewegen Pfeiltasten den Zeiger, die Leertaste beginnt und beendet einen Strich, die Rücktaste einen, der löscht.</translation>
    </message>
    <message>
        <source>A</source>
        <translation>A</translation>
    </message>
</context>
<context>
    <name>nutik::studio::CurveEditor</name>
    <message>
        <source>Gain curve</source>
        <translation>Gain-Kurve</translation>
    </message>
    <message>
        <source>Points keep their order: the time must be before %1</source>
        <translation>Punkte behalten ihre Reihenfolge: Die Zeit muss vor %1 liegen</translation>
    </message>
    <message>
        <source>Points keep their order: the time must be after %1</source>
        <translation>Punkte behalten ihre Reihenfolge: Die Zeit muss nach %1 liegen</translation>
    </message>
    <message>
        <source>Points keep their order: the time must be after %1 and before %2</source>
        <translation>Punkte behalten ihre Reihenfolge: Die Zeit muss nach %1 und vor %2 liegen</translation>
    </message>
    <message>
        <source>Set point</source>
        <translation>Punkt setzen</translation>
    </message>
    <message>
        <source>%1 (M%2)</source>
        <translation>%1 (M%2)</translation>
    </message>
    <message>
        <source>%1, %2 control points</source>
        <translation>%1, Kontrollpunkte: %2</translation>
    </message>
    <message>
        <source>; point %1: %2</source>
        <translation>; Punkt %1: %2</translation>
    </message>
    <message>
        <source>; %1 selected</source>
        <translation>; ausgewählt: %1</translation>
    </message>
    <message>
        <source>in mark</source>
        <translation>In-Marke</translation>
    </message>
    <message>
        <source>out mark</source>
        <translation>Out-Marke</translation>
    </message>
    <message>
        <source>where it was</source>
        <translation>wo er war</translation>
    </message>
    <message>
        <source>as it was</source>
        <translation>wie er war</translation>
    </message>
    <message>
        <source>gain</source>
        <translation>Gain</translation>
    </message>
    <message>
        <source>light of pixel %1, %2, up to %3</source>
        <translation>Licht des Pixels %1, %2, bis %3</translation>
    </message>
    <message>
        <source>(1 of %1) </source>
        <translation>(1 von %1) </translation>
    </message>
    <message>
        <source>This region has no function yet: press Insert for a first point</source>
        <translation>Diese Region hat noch keine Funktion: Einfg setzt einen ersten Punkt</translation>
    </message>
    <message>
        <source>Move point</source>
        <translation>Punkt verschieben</translation>
    </message>
    <message>
        <source>Change gain</source>
        <translation>Gain ändern</translation>
    </message>
    <message>
        <source>A function keeps one point at least</source>
        <translation>Eine Funktion behält mindestens einen Punkt</translation>
    </message>
    <message>
        <source>Remove point</source>
        <translation>Punkt entfernen</translation>
    </message>
    <message>
        <source>Remove %1 points</source>
        <translation>%1 Punkte entfernen</translation>
    </message>
    <message>
        <source>Add point</source>
        <translation>Punkt hinzufügen</translation>
    </message>
    <message>
        <source>There is no room for a point between these two</source>
        <translation>Zwischen diesen beiden ist kein Platz für einen Punkt</translation>
    </message>
    <message>
        <source>Gain: what the light of a moment is multiplied by. Ctrl and wheel zoom, a double click shows all gains</source>
        <translation>Gain: womit das Licht eines Augenblicks multipliziert wird. Strg und Mausrad zoomen, ein Doppelklick zeigt alle Gains</translation>
    </message>
    <message>
        <source>Point %1 of M%2: %3</source>
        <translation>Punkt %1 von M%2: %3</translation>
    </message>
    <message>
        <source>Drag to move it, double click to type, right click to take it away</source>
        <translation>Ziehen verschiebt ihn, Doppelklick zum Eintippen, Rechtsklick entfernt ihn</translation>
    </message>
    <message>
        <source>Drag to move this boxcar</source>
        <translation>Ziehen verschiebt dieses Rechteck</translation>
    </message>
    <message>
        <source>Drag to move the boxcar&apos;s begin</source>
        <translation>Ziehen verschiebt den Anfang des Rechtecks</translation>
    </message>
    <message>
        <source>Drag to move the boxcar&apos;s end</source>
        <translation>Ziehen verschiebt das Ende des Rechtecks</translation>
    </message>
    <message>
        <source>Drag to change the boxcar&apos;s gain</source>
        <translation>Ziehen ändert den Gain des Rechtecks</translation>
    </message>
    <message>
        <source>Drag to stretch the selected points in time</source>
        <translation>Ziehen dehnt die ausgewählten Punkte in der Zeit</translation>
    </message>
    <message>
        <source>Drag to multiply the selected points&apos; gains</source>
        <translation>Ziehen multipliziert die Gains der ausgewählten Punkte</translation>
    </message>
    <message>
        <source>Click for a new point</source>
        <translation>Klick für einen neuen Punkt</translation>
    </message>
    <message>
        <source>Drag to move the selected points</source>
        <translation>Ziehen verschiebt die ausgewählten Punkte</translation>
    </message>
    <message>
        <source>Drag to stretch the selected points in time and to multiply their gains</source>
        <translation>Ziehen dehnt die ausgewählten Punkte in der Zeit und multipliziert ihre Gains</translation>
    </message>
    <message>
        <source>There is a point at this time already</source>
        <translation>Zu dieser Zeit gibt es schon einen Punkt</translation>
    </message>
</context>
<context>
    <name>nutik::studio::Document</name>
    <message>
        <source>end of the capture</source>
        <translation>Ende der Aufnahme</translation>
    </message>
    <message>
        <source>Move point</source>
        <translation>Punkt verschieben</translation>
    </message>
    <message>
        <source>Move %1 points</source>
        <translation>%1 Punkte verschieben</translation>
    </message>
    <message>
        <source>Stretch points in time</source>
        <translation>Punkte in der Zeit dehnen</translation>
    </message>
    <message>
        <source>Multiply gains</source>
        <translation>Gains multiplizieren</translation>
    </message>
    <message>
        <source>Stretch points in time and gain</source>
        <translation>Punkte in Zeit und Gain dehnen</translation>
    </message>
    <message>
        <source>%1 long, × %2</source>
        <translation>Länge %1, × %2</translation>
    </message>
    <message>
        <source>gain %1, × %2</source>
        <translation>Gain %1, × %2</translation>
    </message>
    <message>
        <source>gain %1</source>
        <translation>Gain %1</translation>
    </message>
    <message>
        <source>%1 to %2, %3 long</source>
        <translation>%1 bis %2, Länge %3</translation>
    </message>
    <message>
        <source>Move boxcar</source>
        <translation>Rechteck verschieben</translation>
    </message>
    <message>
        <source>Move boxcar&apos;s begin</source>
        <translation>Anfang des Rechtecks verschieben</translation>
    </message>
    <message>
        <source>Move boxcar&apos;s end</source>
        <translation>Ende des Rechtecks verschieben</translation>
    </message>
    <message>
        <source>Change boxcar&apos;s gain</source>
        <translation>Gain des Rechtecks ändern</translation>
    </message>
    <message>
        <source>gain 0</source>
        <translation>Gain 0</translation>
    </message>
    <message>
        <source>gain 1</source>
        <translation>Gain 1</translation>
    </message>
    <message>
        <source>start of the capture</source>
        <translation>Anfang der Aufnahme</translation>
    </message>
    <message>
        <source>point of M%1</source>
        <translation>Punkt von M%1</translation>
    </message>
    <message>
        <source>%1, gain %2</source>
        <translation>%1, Gain %2</translation>
    </message>
    <message>
        <source>Expose the interval</source>
        <translation>Intervall belichten</translation>
    </message>
    <message>
        <source>Expose regions</source>
        <translation>Regionen belichten</translation>
    </message>
    <message>
        <source>Background</source>
        <translation>Hintergrund</translation>
    </message>
    <message>
        <source>Region %1</source>
        <translation>Region %1</translation>
    </message>
    <message>
        <source>%1 pixels %2</source>
        <translation>%1 Pixel %2</translation>
    </message>
    <message>
        <source>, by more than %1 codes</source>
        <translation>, um mehr als %1 Codes</translation>
    </message>
    <message>
        <source>%1: the region stays as it is.</source>
        <translation>%1: Die Region bleibt, wie sie ist.</translation>
    </message>
    <message>
        <source>Select what moves</source>
        <translation>Bewegtes auswählen</translation>
    </message>
    <message>
        <source>move within the capture</source>
        <translation>mit Bewegung in der Aufnahme</translation>
    </message>
    <message>
        <source>move between the marks</source>
        <translation>mit Bewegung zwischen den Marken</translation>
    </message>
    <message>
        <source>Select what differs</source>
        <translation>Abweichendes auswählen</translation>
    </message>
    <message>
        <source>differ between %1 and %2</source>
        <translation>mit Unterschied zwischen %1 und %2</translation>
    </message>
    <message>
        <source>Brush</source>
        <translation>Pinsel</translation>
    </message>
    <message>
        <source>Ellipse</source>
        <translation>Ellipse</translation>
    </message>
    <message>
        <source>Rectangle</source>
        <translation>Rechteck</translation>
    </message>
    <message>
        <source>Polygon</source>
        <translation>Polygon</translation>
    </message>
    <message>
        <source>Magic wand</source>
        <translation>Zauberstab</translation>
    </message>
    <message>
        <source>Add region</source>
        <translation>Region hinzufügen</translation>
    </message>
    <message>
        <source>Remove region</source>
        <translation>Region entfernen</translation>
    </message>
    <message>
        <source>Move region up</source>
        <translation>Region nach oben</translation>
    </message>
    <message>
        <source>Move region down</source>
        <translation>Region nach unten</translation>
    </message>
    <message>
        <source>Expose over the interval</source>
        <translation>Über das Intervall belichten</translation>
    </message>
    <message>
        <source>Shrink region</source>
        <translation>Region verkleinern</translation>
    </message>
    <message>
        <source>Grow region</source>
        <translation>Region vergrößern</translation>
    </message>
    <message>
        <source>Smooth region</source>
        <translation>Region glätten</translation>
    </message>
    <message>
        <source>Feather</source>
        <translation>Weiche Kanten</translation>
    </message>
    <message>
        <source>Feather of region</source>
        <translation>Weiche Kanten der Region</translation>
    </message>
    <message>
        <source>as is usual</source>
        <translation>wie üblich</translation>
    </message>
    <message>
        <source>Its ending says which kind of file it is: %1</source>
        <translation>Die Endung bestimmt das Dateiformat: %1</translation>
    </message>
    <message>
        <source>&amp;Browse…</source>
        <translation>&amp;Durchsuchen…</translation>
    </message>
    <message>
        <source>&amp;File</source>
        <translation>&amp;Datei</translation>
    </message>
    <message>
        <source>%1 is there already. Replace it?</source>
        <translation>%1 gibt es schon. Ersetzen?</translation>
    </message>
    <message>
        <source>At %1</source>
        <translation>Bei %1</translation>
    </message>
    <message>
        <source>&amp;Motion study</source>
        <translation>&amp;Bewegungsstudie</translation>
    </message>
    <message>
        <source>Sharp moments over the trail of the whole way</source>
        <translation>Scharfe Momente über der Spur des ganzen Weges</translation>
    </message>
    <message>
        <source>&amp;Strobe</source>
        <translation>&amp;Stroboskop</translation>
    </message>
    <message>
        <source>Sharp moments, and nothing between them</source>
        <translation>Scharfe Momente, und nichts dazwischen</translation>
    </message>
    <message>
        <source>&amp;Rear curtain</source>
        <translation>Zweiter &amp;Vorhang</translation>
    </message>
    <message>
        <source>The last moment, and a trail that grows towards it</source>
        <translation>Der letzte Moment, und eine Spur, die zu ihm hin zunimmt</translation>
    </message>
    <message>
        <source>&amp;Frozen subject</source>
        <translation>&amp;Eingefrorenes Motiv</translation>
    </message>
    <message>
        <source>One moment in a scene that is exposed for all of the time</source>
        <translation>Ein Moment in einer Szene, die die ganze Zeit belichtet wird</translation>
    </message>
    <message>
        <source>S&amp;lit-scan</source>
        <translation>Sl&amp;it-Scan</translation>
    </message>
    <message>
        <source>Strips side by side, each at a moment of its own</source>
        <translation>Streifen nebeneinander, jeder zu seiner eigenen Zeit</translation>
    </message>
    <message>
        <source>Remove &amp;people</source>
        <translation>&amp;Menschen entfernen</translation>
    </message>
    <message>
        <source>The empty scene, without what moves</source>
        <translation>Die leere Szene, ohne Bewegtes</translation>
    </message>
    <message>
        <source>Lon&amp;g exposure</source>
        <translation>&amp;Langzeitbelichtung</translation>
    </message>
    <message>
        <source>All of the time in one picture: silky water, trails of light</source>
        <translation>Die ganze Zeit in einem Bild: seidiges Wasser, Lichtspuren</translation>
    </message>
    <message>
        <source>Starting point</source>
        <translation>Ausgangspunkt</translation>
    </message>
    <message>
        <source>
Times and pictures count from In.</source>
        <translation>
Zeiten und Bilder zählen ab In.</translation>
    </message>
    <message>
        <source>%1: the scene without what moves</source>
        <translation>%1: die Szene ohne Bewegtes</translation>
    </message>
    <message>
        <source>%1 of %2 pictures are there. Replace them?</source>
        <translation>%1 von %2 Bildern gibt es schon. Ersetzen?</translation>
    </message>
    <message>
        <source>%1: %2 of %3 frames were written</source>
        <translation>%1: %2 von %3 Bildern geschrieben</translation>
    </message>
    <message numerus="yes">
        <source>%1: %n frame(s)</source>
        <translation>
            <numerusform>%1: %n Bild</numerusform>
            <numerusform>%1: %n Bilder</numerusform>
        </translation>
    </message>
    <message>
        <source>(default: </source>
        <translation>(Standard: </translation>
    </message>
    <message>
        <source>The selected region gets the pixels in which the capture&apos;s pictures at two moments differ.</source>
        <translation>Die ausgewählte Region erhält die Pixel, in denen sich die Bilder der Aufnahme zu zwei Zeitpunkten unterscheiden.</translation>
    </message>
    <message>
        <source>&amp;From</source>
        <translation>&amp;Von</translation>
    </message>
    <message>
        <source>The one moment</source>
        <translation>Der eine Zeitpunkt</translation>
    </message>
    <message>
        <source>&amp;To</source>
        <translation>&amp;Bis</translation>
    </message>
    <message>
        <source>The other moment</source>
        <translation>Der andere Zeitpunkt</translation>
    </message>
    <message>
        <source>&amp;More than</source>
        <translation>&amp;Mehr als</translation>
    </message>
    <message>
        <source>How many codes a difference has to exceed</source>
        <translation>Wie viele Codes ein Unterschied übersteigen muss</translation>
    </message>
    <message>
        <source>Smaller differences are none. 0: what the sensor&apos;s noise explains, told from the pictures</source>
        <translation>Kleinere Unterschiede zählen nicht. 0: was das Sensorrauschen erklärt, aus den Bildern ermittelt</translation>
    </message>
    <message>
        <source>as the noise is</source>
        <translation>nach dem Rauschen</translation>
    </message>
    <message>
        <source> codes</source>
        <translation> Codes</translation>
    </message>
    <message>
        <source>Only the &amp;largest part</source>
        <translation>Nur das &amp;größte Stück</translation>
    </message>
    <message>
        <source>Select</source>
        <translation>Auswählen</translation>
    </message>
    <message>
        <source>The capture has pictures from 0 s to %1: %2 is not within</source>
        <translation>Die Aufnahme hat Bilder von 0 s bis %1: %2 liegt außerhalb</translation>
    </message>
    <message>
        <source>Samples were made between pictures %1 … %2, so that no frame shows what moves two or three times.</source>
        <translation>Zwischen den Bildern %1 … %2 wurden Samples erzeugt, damit kein Filmbild Bewegtes zwei- oder dreifach zeigt.</translation>
    </message>
    <message>
        <source>Its frames show what moves two or three times: %1</source>
        <translation>Seine Bilder zeigen Bewegtes zwei- oder dreifach: %1</translation>
    </message>
</context>
<context>
    <name>nutik::studio::Jobs</name>
    <message>
        <source>There is not enough memory for this.</source>
        <translation>Dafür reicht der Speicher nicht.</translation>
    </message>
    <message>
        <source>It failed, and nothing is known of why.</source>
        <translation>Fehlgeschlagen; die Ursache ist unbekannt.</translation>
    </message>
    <message>
        <source> (File, How the clip is read)</source>
        <translation> (Datei, Wie der Clip gelesen wird)</translation>
    </message>
    <message>
        <source>%1 was written: %2, %3</source>
        <translation>%1 wurde geschrieben: %2, %3</translation>
    </message>
    <message>
        <source>no pixel is clipped</source>
        <translation>kein Pixel übersteuert</translation>
    </message>
</context>
<context>
    <name>nutik::studio::LightHistogram</name>
    <message>
        <source>Histogram</source>
        <translation>Histogramm</translation>
    </message>
    <message>
        <source>How many pixels have which brightness, from black to white and %1 stops beyond. The line is the selected region&apos;s brightest channel.</source>
        <translation>Wie viele Pixel welche Helligkeit haben, von Schwarz bis Weiß und %1 Blenden darüber. Die Linie ist der hellste Kanal der ausgewählten Region.</translation>
    </message>
    <message>
        <source>%1: %2 px beyond white, %3 px below 0</source>
        <translation>%1: %2 px über Weiß, %3 px unter 0</translation>
    </message>
</context>
<context>
    <name>nutik::studio::LiveView</name>
    <message>
        <source>Feathering</source>
        <translation>Kanten werden weichgezeichnet</translation>
    </message>
</context>
<context>
    <name>nutik::studio::MainWindow</name>
    <message>
        <source>%1 is there already. Replace it?</source>
        <translation>%1 gibt es schon. Ersetzen?</translation>
    </message>
    <message>
        <source>%1 was changed by another program since it was read.</source>
        <translation>%1 wurde von einem anderen Programm geändert, seit es gelesen wurde.</translation>
    </message>
    <message>
        <source>%1 was not written for this project.</source>
        <translation>%1 wurde nicht für dieses Projekt geschrieben.</translation>
    </message>
    <message>
        <source>Replace what is there? Save project as… writes new files.</source>
        <translation>Vorhandenes ersetzen? „Projekt speichern unter…“ schreibt neue Dateien.</translation>
    </message>
    <message>
        <source>Files of others</source>
        <translation>Fremde Dateien</translation>
    </message>
    <message>
        <source>%1 is gone</source>
        <translation>%1 ist nicht mehr da</translation>
    </message>
    <message>
        <source>%1 was changed by another program</source>
        <translation>%1 wurde von einem anderen Programm geändert</translation>
    </message>
    <message>
        <source>%1: the window goes on with what it read.</source>
        <translation>%1: Das Fenster arbeitet mit dem weiter, was es gelesen hat.</translation>
    </message>
    <message>
        <source>%1: saving the project writes it again.</source>
        <translation>%1: Speichern des Projekts schreibt die Datei neu.</translation>
    </message>
    <message>
        <source>%1: File, Open again (F5) takes the change; saving replaces it.</source>
        <translation>%1: „Datei, Erneut öffnen“ (F5) übernimmt die Änderung; Speichern ersetzt sie.</translation>
    </message>
    <message>
        <source>Unsaved work</source>
        <translation>Nicht gespeicherte Arbeit</translation>
    </message>
    <message numerus="yes">
        <source>Remove unsaved work of %n window(s) for good?</source>
        <translation>
            <numerusform>Nicht gespeicherte Arbeit von %n Fenster endgültig entfernen?</numerusform>
            <numerusform>Nicht gespeicherte Arbeit von %n Fenstern endgültig entfernen?</numerusform>
        </translation>
    </message>
    <message>
        <source>%1, %2</source>
        <translation>%1, %2</translation>
    </message>
    <message>
        <source>&amp;Remove all of these…</source>
        <translation>Alle &amp;entfernen…</translation>
    </message>
    <message>
        <source>Save the project</source>
        <translation>Projekt speichern</translation>
    </message>
    <message>
        <source>Projects (*%1)</source>
        <translation>Projekte (*%1)</translation>
    </message>
    <message>
        <source>Unsaved changes</source>
        <translation>Nicht gespeicherte Änderungen</translation>
    </message>
    <message>
        <source>Regions, functions or marks were changed and not saved. Save them?</source>
        <translation>Regionen, Funktionen oder Marken wurden geändert und nicht gespeichert. Speichern?</translation>
    </message>
    <message>
        <source>Copied: %1</source>
        <translation>Kopiert: %1</translation>
    </message>
    <message>
        <source>Load functions</source>
        <translation>Funktionen laden</translation>
    </message>
    <message>
        <source>Load mask</source>
        <translation>Maske laden</translation>
    </message>
    <message>
        <source>Written: %1</source>
        <translation>Geschrieben: %1</translation>
    </message>
    <message>
        <source> Its edges are hard; their feather, %1, is not in the file.</source>
        <translation> Ihre Kanten sind hart; deren Weichzeichnung, %1, steht nicht in der Datei.</translation>
    </message>
    <message>
        <source>Written: %1.%2</source>
        <translation>Geschrieben: %1.%2</translation>
    </message>
    <message>
        <source>Looking for the empty scene</source>
        <translation>Leere Szene wird gesucht</translation>
    </message>
    <message>
        <source>Save what is whole</source>
        <translation>Unbeschädigtes speichern</translation>
    </message>
    <message>
        <source>Captures (*.tik)</source>
        <translation>Aufnahmen (*.tik)</translation>
    </message>
    <message>
        <source>Saving what is whole</source>
        <translation>Unbeschädigtes wird gespeichert</translation>
    </message>
    <message>
        <source>%1: %2 samples were saved</source>
        <translation>%1: %2 Samples gespeichert</translation>
    </message>
    <message>
        <source>None yet</source>
        <translation>Noch keine</translation>
    </message>
    <message>
        <source>There is unsaved work of a window that did not end well: File, Recover unsaved work.</source>
        <translation>Es gibt nicht gespeicherte Arbeit eines abgestürzten Fensters: „Datei, Nicht gespeicherte Arbeit wiederherstellen“.</translation>
    </message>
    <message>
        <source>%1: %2</source>
        <translation>%1: %2</translation>
    </message>
    <message>
        <source>Opening %1</source>
        <translation>%1 wird geöffnet</translation>
    </message>
    <message>
        <source>%1

How many pictures a second was it filmed with?</source>
        <translation>%1

Mit wie vielen Bildern pro Sekunde wurde gefilmt?</translation>
    </message>
    <message>
        <source>Locate…</source>
        <translation>Suchen…</translation>
    </message>
    <message>
        <source>Where is it?</source>
        <translation>Wo ist die Datei?</translation>
    </message>
    <message>
        <source>All files (*)</source>
        <translation>Alle Dateien (*)</translation>
    </message>
    <message>
        <source>Open that part</source>
        <translation>Diesen Teil öffnen</translation>
    </message>
    <message>
        <source>Save what is whole…</source>
        <translation>Unbeschädigtes speichern…</translation>
    </message>
    <message>
        <source>Opening %1: %2</source>
        <translation>Beim Öffnen von %1: %2</translation>
    </message>
    <message>
        <source>How the clip is read</source>
        <translation>Wie der Clip gelesen wird</translation>
    </message>
    <message>
        <source>no: it stood still</source>
        <translation>nein: sie stand still</translation>
    </message>
    <message>
        <source>it shifted</source>
        <translation>sie verschob sich</translation>
    </message>
    <message>
        <source>it shifted and turned</source>
        <translation>sie verschob und drehte sich</translation>
    </message>
    <message>
        <source>it tilted, too</source>
        <translation>sie kippte auch</translation>
    </message>
    <message>
        <source>find out</source>
        <translation>herausfinden</translation>
    </message>
    <message>
        <source>The project&apos;s last save did not come to its end. It is shown as it was to be; its functions and mask may be as they were before. Saving it writes them.</source>
        <translation>Das Projekt wurde zuletzt nicht bis zum Ende gespeichert. Gezeigt wird, was gespeichert werden sollte; seine Dateien mit Funktionen und Maske können noch die vorherigen sein. Speichern schreibt sie.</translation>
    </message>
    <message>
        <source>Making thumbnails</source>
        <translation>Vorschaubilder entstehen</translation>
    </message>
    <message>
        <source>Looking for motion</source>
        <translation>Bewegung wird gesucht</translation>
    </message>
    <message>
        <source>Making smaller pictures for the screen</source>
        <translation>Kleinere Bilder für den Bildschirm entstehen</translation>
    </message>
    <message>
        <source>Reading a pixel</source>
        <translation>Pixel wird gelesen</translation>
    </message>
    <message>
        <source>Select a region first, or add one: the background is what no region has.</source>
        <translation>Wählen Sie erst eine Region oder fügen Sie eine hinzu: Der Hintergrund ist, was keine Region hat.</translation>
    </message>
    <message>
        <source>Looking for what moves</source>
        <translation>Bewegtes wird gesucht</translation>
    </message>
    <message>
        <source>Looking for what differs</source>
        <translation>Abweichendes wird gesucht</translation>
    </message>
    <message>
        <source>nutik studio</source>
        <translation>nutik studio</translation>
    </message>
    <message>
        <source>%1[*] – nutik studio</source>
        <translation>%1[*] – nutik studio</translation>
    </message>
    <message>
        <source>&amp;Edit</source>
        <translation>&amp;Bearbeiten</translation>
    </message>
    <message>
        <source>&amp;Undo</source>
        <translation>&amp;Rückgängig</translation>
    </message>
    <message>
        <source>&amp;Redo</source>
        <translation>&amp;Wiederholen</translation>
    </message>
    <message>
        <source>Tools</source>
        <translation>Werkzeuge</translation>
    </message>
    <message>
        <source>&amp;File</source>
        <translation>&amp;Datei</translation>
    </message>
    <message>
        <source>&amp;Open…</source>
        <translation>Ö&amp;ffnen…</translation>
    </message>
    <message>
        <source>Open &amp;recent</source>
        <translation>&amp;Zuletzt geöffnet</translation>
    </message>
    <message>
        <source>Reco&amp;ver unsaved work</source>
        <translation>Nicht gespeicherte Arbeit &amp;wiederherstellen</translation>
    </message>
    <message>
        <source>Open a&amp;gain</source>
        <translation>Er&amp;neut öffnen</translation>
    </message>
    <message>
        <source>How &amp;the clip is read…</source>
        <translation>Wie der &amp;Clip gelesen wird…</translation>
    </message>
    <message>
        <source>The clip is opened again.</source>
        <translation>Der Clip wird erneut geöffnet.</translation>
    </message>
    <message>
        <source>&amp;Save project</source>
        <translation>Projekt &amp;speichern</translation>
    </message>
    <message>
        <source>Save project &amp;as…</source>
        <translation>Projekt speichern &amp;unter…</translation>
    </message>
    <message>
        <source>Load &amp;functions…</source>
        <translation>Funktionen &amp;laden…</translation>
    </message>
    <message>
        <source>Function files (*.fn);;All files (*)</source>
        <translation>Funktionsdateien (*.fn);;Alle Dateien (*)</translation>
    </message>
    <message>
        <source>Load &amp;mask…</source>
        <translation>&amp;Maske laden…</translation>
    </message>
    <message>
        <source>Masks (*.pgm *.png);;All files (*)</source>
        <translation>Masken (*.pgm *.png);;Alle Dateien (*)</translation>
    </message>
    <message>
        <source>Save f&amp;unctions as…</source>
        <translation>Fun&amp;ktionen speichern unter…</translation>
    </message>
    <message>
        <source>Save the functions</source>
        <translation>Funktionen speichern</translation>
    </message>
    <message>
        <source>Function files (*.fn)</source>
        <translation>Funktionsdateien (*.fn)</translation>
    </message>
    <message>
        <source>Save mas&amp;k as…</source>
        <translation>Maske speiche&amp;rn unter…</translation>
    </message>
    <message>
        <source>Save the mask</source>
        <translation>Maske speichern</translation>
    </message>
    <message>
        <source>Masks (*.pgm *.png)</source>
        <translation>Masken (*.pgm *.png)</translation>
    </message>
    <message>
        <source>&amp;Export picture…</source>
        <translation>&amp;Bild exportieren…</translation>
    </message>
    <message>
        <source>Export f&amp;ilm…</source>
        <translation>F&amp;ilm exportieren…</translation>
    </message>
    <message>
        <source>&amp;Copy as command</source>
        <translation>Als Bef&amp;ehl kopieren</translation>
    </message>
    <message>
        <source>&amp;Quit</source>
        <translation>Been&amp;den</translation>
    </message>
    <message>
        <source>&amp;Regions</source>
        <translation>&amp;Regionen</translation>
    </message>
    <message>
        <source>&amp;Add region</source>
        <translation>Region &amp;hinzufügen</translation>
    </message>
    <message>
        <source>&amp;Remove region</source>
        <translation>Region &amp;entfernen</translation>
    </message>
    <message>
        <source>Move &amp;up</source>
        <translation>Nach &amp;oben</translation>
    </message>
    <message>
        <source>Move &amp;down</source>
        <translation>Nach &amp;unten</translation>
    </message>
    <message>
        <source>&amp;Expose over the interval</source>
        <translation>Über das &amp;Intervall belichten</translation>
    </message>
    <message>
        <source>&amp;Solo: darken the others</source>
        <translation>&amp;Solo: andere abdunkeln</translation>
    </message>
    <message>
        <source>Select what &amp;moves</source>
        <translation>&amp;Bewegtes auswählen</translation>
    </message>
    <message>
        <source>Select what di&amp;ffers…</source>
        <translation>&amp;Abweichendes auswählen…</translation>
    </message>
    <message>
        <source>&amp;Help</source>
        <translation>&amp;Hilfe</translation>
    </message>
    <message>
        <source>&amp;Keys and mouse</source>
        <translation>&amp;Tasten und Maus</translation>
    </message>
    <message>
        <source>&amp;About nutik studio</source>
        <translation>Ü&amp;ber nutik studio</translation>
    </message>
    <message>
        <source>About nutik studio</source>
        <translation>Über nutik studio</translation>
    </message>
    <message>
        <source>nutik studio %1

Time and gain after filming: gain functions and masks are drawn while the picture follows. It writes what nutik-cl reads.</source>
        <translation>nutik studio %1

Zeit und Gain nach dem Filmen: Gain-Funktionen und Masken werden gezeichnet, und das Bild folgt. Geschrieben wird, was nutik-cl liest.</translation>
    </message>
    <message>
        <source>Keys and mouse</source>
        <translation>Tasten und Maus</translation>
    </message>
    <message>
        <source>&amp;Start from</source>
        <translation>&amp;Start mit</translation>
    </message>
    <message>
        <source>Study with &amp;choices…</source>
        <translation>Studie mit &amp;Optionen…</translation>
    </message>
    <message>
        <source>&amp;Empty scene, as a picture…</source>
        <translation>Leere S&amp;zene als Bild…</translation>
    </message>
    <message>
        <source>Write the empty scene</source>
        <translation>Leere Szene schreiben</translation>
    </message>
    <message>
        <source>Pictures (%1)</source>
        <translation>Bilder (%1)</translation>
    </message>
    <message>
        <source>&amp;View</source>
        <translation>&amp;Ansicht</translation>
    </message>
    <message>
        <source>Zoom &amp;in</source>
        <translation>&amp;Vergrößern</translation>
    </message>
    <message>
        <source>Zoom &amp;out</source>
        <translation>Ver&amp;kleinern</translation>
    </message>
    <message>
        <source>&amp;Fit</source>
        <translation>&amp;Einpassen</translation>
    </message>
    <message>
        <source>&amp;Pixel for pixel</source>
        <translation>&amp;Pixel für Pixel</translation>
    </message>
    <message>
        <source>All of the &amp;time</source>
        <translation>Ganze &amp;Zeit</translation>
    </message>
    <message>
        <source>Pla&amp;y or stop</source>
        <translation>&amp;Abspielen oder anhalten</translation>
    </message>
    <message>
        <source>Plays the interval through the capture, or from In to Out (Space)</source>
        <translation>Spielt das Intervall durch die Aufnahme oder von In bis Out ab (Leertaste)</translation>
    </message>
    <message>
        <source>Mark &amp;clipped light</source>
        <translation>Über&amp;steuertes markieren</translation>
    </message>
    <message>
        <source>&amp;Keep as snapshot A</source>
        <translation>Als Schnappschuss A &amp;merken</translation>
    </message>
    <message>
        <source>S&amp;wap with snapshot A</source>
        <translation>Mit Schnappschuss A &amp;tauschen</translation>
    </message>
    <message>
        <source>%1 (%2): shown or folded</source>
        <translation>%1 (%2): ein- oder ausgeblendet</translation>
    </message>
    <message>
        <source>Time &amp;strip</source>
        <translation>Zeit&amp;leiste</translation>
    </message>
    <message>
        <source>C&amp;urves</source>
        <translation>K&amp;urven</translation>
    </message>
    <message>
        <source>&amp;Regions and exposure</source>
        <translation>&amp;Regionen und Belichtung</translation>
    </message>
    <message>
        <source>&amp;Appearance</source>
        <translation>&amp;Darstellung</translation>
    </message>
    <message>
        <source>&amp;Dark</source>
        <translation>&amp;Dunkel</translation>
    </message>
    <message>
        <source>&amp;Light</source>
        <translation>&amp;Hell</translation>
    </message>
    <message>
        <source>&amp;System</source>
        <translation>&amp;System</translation>
    </message>
    <message>
        <source>%1 (%2): %3</source>
        <translation>%1 (%2): %3</translation>
    </message>
    <message>
        <source>Brush </source>
        <translation>Pinsel </translation>
    </message>
    <message>
        <source> px</source>
        <translation> px</translation>
    </message>
    <message>
        <source>Radius of the brush, in pixels</source>
        <translation>Radius des Pinsels, in Pixeln</translation>
    </message>
    <message>
        <source>Wand ± </source>
        <translation>Toleranz ± </translation>
    </message>
    <message>
        <source>How many codes of 255 a pixel may differ by from the one that the wand clicked</source>
        <translation>Um wie viele Codes von 255 ein Pixel von dem abweichen darf, auf den der Zauberstab geklickt hat</translation>
    </message>
    <message>
        <source>One interval for all</source>
        <translation>Ein Intervall für alle</translation>
    </message>
    <message>
        <source>Each region its own</source>
        <translation>Jede Region eigens</translation>
    </message>
    <message>
        <source>What is exposed: the interval everywhere, or each region&apos;s function</source>
        <translation>Was belichtet wird: überall das Intervall, oder die Funktion jeder Region</translation>
    </message>
    <message>
        <source>Average while open, as a camera</source>
        <translation>Mittel, solange offen: wie Kamera</translation>
    </message>
    <message>
        <source>Still things keep their brightness</source>
        <translation>Ruhendes behält seine Helligkeit</translation>
    </message>
    <message>
        <source>Average, whatever the gain&apos;s sign</source>
        <translation>Mittel, ohne Vorzeichen des Gains</translation>
    </message>
    <message>
        <source>Brightness: what the exposure is divided by</source>
        <translation>Helligkeit: wodurch die Belichtung geteilt wird</translation>
    </message>
    <message>
        <source>What the exposure is divided by: the time with a gain; its integral, so that what rests keeps its brightness; that of its magnitude</source>
        <translation>Wodurch die Belichtung geteilt wird: die Zeit mit einem Gain; sein Integral, so dass Ruhendes seine Helligkeit behält; das seines Betrags</translation>
    </message>
    <message>
        <source>Normalize</source>
        <translation>Normieren</translation>
    </message>
    <message>
        <source>EV </source>
        <translation>EV </translation>
    </message>
    <message>
        <source>Brightness, in stops</source>
        <translation>Helligkeit, in Blenden</translation>
    </message>
    <message>
        <source>Brightness</source>
        <translation>Helligkeit</translation>
    </message>
    <message>
        <source>Speed of the film: 0.25 is four times slower than life</source>
        <translation>Geschwindigkeit des Films: 0.25 ist viermal langsamer als das Leben</translation>
    </message>
    <message>
        <source>Film </source>
        <translation>Film </translation>
    </message>
    <message>
        <source>Shutter angle of the film: 360° is all of the time to the next frame</source>
        <translation>Verschlusswinkel des Films: 360° ist die ganze Zeit bis zum nächsten Bild</translation>
    </message>
    <message>
        <source>Measuring the light</source>
        <translation>Licht wird gemessen</translation>
    </message>
    <message>
        <source>Stop the film first: snapshot A is of the picture.</source>
        <translation>Halten Sie erst den Film an: Schnappschuss A gilt dem Bild.</translation>
    </message>
    <message>
        <source>Swap with snapshot A</source>
        <translation>Mit Schnappschuss A tauschen</translation>
    </message>
    <message>
        <source>Open</source>
        <translation>Öffnen</translation>
    </message>
    <message>
        <source>Clips, captures and projects (*.tik *.nutik *.mp4 *.mov *.mkv *.avi *.cine %1);;All files (*)</source>
        <translation>Clips, Aufnahmen und Projekte (*.tik *.nutik *.mp4 *.mov *.mkv *.avi *.cine %1);;Alle Dateien (*)</translation>
    </message>
    <message>
        <source>Long exposure</source>
        <translation>Langzeitbelichtung</translation>
    </message>
    <message>
        <source>Looking for a subject</source>
        <translation>Motiv wird gesucht</translation>
    </message>
    <message>
        <source>Hold the camera still</source>
        <translation>Kamera stillhalten</translation>
    </message>
    <message>
        <source>Motion study</source>
        <translation>Bewegungsstudie</translation>
    </message>
    <message>
        <source>Without what moves. Escape: back to the picture</source>
        <translation>Ohne Bewegtes. Esc: zurück zum Bild</translation>
    </message>
    <message>
        <source>Save…</source>
        <translation>Speichern…</translation>
    </message>
    <message>
        <source>Films and numbered pictures (*.mp4 *.mov *.mkv *.webm *.gif *.webp *-%05d.png)</source>
        <translation>Filme und nummerierte Bilder (*.mp4 *.mov *.mkv *.webm *.gif *.webp *-%05d.png)</translation>
    </message>
    <message>
        <source>Filming %1</source>
        <translation>%1 wird gefilmt</translation>
    </message>
    <message>
        <source>Export the picture</source>
        <translation>Bild exportieren</translation>
    </message>
    <message>
        <source>Writing %1</source>
        <translation>%1 wird geschrieben</translation>
    </message>
    <message>
        <source>Files are being written</source>
        <translation>Es werden Dateien geschrieben</translation>
    </message>
    <message>
        <source>&amp;Finish in the background</source>
        <translation>Im &amp;Hintergrund fertigstellen</translation>
    </message>
    <message>
        <source>&amp;Stop</source>
        <translation>&amp;Stoppen</translation>
    </message>
    <message>
        <source>%1: the program ended before it was done.</source>
        <translation>%1: Das Programm endete, bevor das fertig war.</translation>
    </message>
    <message>
        <source>Save the project first: recipes name its files</source>
        <translation>Erst das Projekt speichern: Rezepte nennen seine Dateien</translation>
    </message>
    <message>
        <source>The scene without what moves. It can be saved as a picture of its own; Escape goes back to the exposure.</source>
        <translation>Die Szene ohne das, was sich bewegt. Sie lässt sich als eigenes Bild speichern; Escape führt zur Belichtung zurück.</translation>
    </message>
    <message>
        <source>Export a film of the regions</source>
        <translation>Einen Film der Regionen exportieren</translation>
    </message>
    <message>
        <source>Export a film</source>
        <translation>Einen Film exportieren</translation>
    </message>
    <message>
        <source>The film begins with the picture that is shown, and the functions of its regions move on through the capture. For a film with a shutter angle choose One interval for all, at the side.</source>
        <translation>Der Film beginnt mit dem gezeigten Bild, und die Funktionen seiner Regionen wandern weiter durch die Aufnahme. Für einen Film mit Verschlusswinkel wählen Sie an der Seite „Ein Intervall für alle“.</translation>
    </message>
    <message>
        <source>its pictures are %3 × %4 pixels large, and the project&apos;s mask %1 × %2</source>
        <translation>seine Bilder sind %3 × %4 Pixel groß, und die Maske des Projekts %1 × %2</translation>
    </message>
    <message>
        <source>Still at work: %1

What is stopped leaves no file, but for the numbered pictures that are there already.</source>
        <translation>In Arbeit: %1

Was gestoppt wird, hinterlässt keine Datei, außer nummerierten Bildern, die schon da sind.</translation>
    </message>
    <message>
        <source>Out lay before In and was taken away.</source>
        <translation>Out lag vor In und wurde entfernt.</translation>
    </message>
    <message>
        <source>In lay behind Out and was taken away.</source>
        <translation>In lag hinter Out und wurde entfernt.</translation>
    </message>
    <message>
        <source>it lasts %1, and the project&apos;s clip %2</source>
        <translation>er dauert %1, und der Clip des Projekts %2</translation>
    </message>
    <message>
        <source>

Use it all the same? Functions and marks keep their times.</source>
        <translation>

Trotzdem verwenden? Funktionen und Marken behalten ihre Zeiten.</translation>
    </message>
    <message>
        <source>Another clip</source>
        <translation>Ein anderer Clip</translation>
    </message>
    <message>
        <source>%1 is not what was read any more: File, Open again (F5) reads what recipes would name.</source>
        <translation>%1 ist nicht mehr, was gelesen wurde: „Datei, Erneut öffnen“ (F5) liest, was Rezepte nennen würden.</translation>
    </message>
    <message>
        <source>The project says how its clip is read: -f %1 is not heeded.</source>
        <translation>Das Projekt sagt, wie sein Clip gelesen wird: -f %1 wird nicht beachtet.</translation>
    </message>
    <message>
        <source>A window shows one clip: %1 is opened, not %2.</source>
        <translation>Ein Fenster zeigt einen Clip: %1 wird geöffnet, nicht %2.</translation>
    </message>
</context>
<context>
    <name>nutik::studio::Notice</name>
    <message>
        <source>Close</source>
        <translation>Schließen</translation>
    </message>
    <message>
        <source>Close the message</source>
        <translation>Meldung schließen</translation>
    </message>
</context>
<context>
    <name>nutik::studio::NumberEditor</name>
    <message>
        <source>&amp;Time</source>
        <translation>&amp;Zeit</translation>
    </message>
    <message>
        <source>&amp;Gain</source>
        <translation>&amp;Gain</translation>
    </message>
    <message>
        <source>Time of the point</source>
        <translation>Zeit des Punktes</translation>
    </message>
    <message>
        <source>Gain of the point</source>
        <translation>Gain des Punktes</translation>
    </message>
    <message>
        <source>Any number, also below 0: what the light of this moment is multiplied by</source>
        <translation>Jede Zahl, auch unter 0: womit das Licht dieses Augenblicks multipliziert wird</translation>
    </message>
</context>
<context>
    <name>nutik::studio::RegionList</name>
    <message>
        <source>Regions</source>
        <translation>Regionen</translation>
    </message>
    <message>
        <source>Region</source>
        <translation>Region</translation>
    </message>
    <message>
        <source>EV</source>
        <translation>EV</translation>
    </message>
    <message>
        <source>Still</source>
        <translation>Ruhe</translation>
    </message>
    <message>
        <source>Clipped</source>
        <translation>Übers.</translation>
    </message>
    <message>
        <source>Solo</source>
        <translation>Solo</translation>
    </message>
    <message>
        <source>The same in stops: 0 is as bright as the capture, −1 half as bright</source>
        <translation>Dasselbe in Blenden: 0 ist so hell wie die Aufnahme, −1 halb so hell</translation>
    </message>
    <message>
        <source>What light that does not change is multiplied by</source>
        <translation>Womit Licht, das sich nicht ändert, multipliziert wird</translation>
    </message>
    <message>
        <source>How many of its pixels have light beyond white, which no code shows</source>
        <translation>Wie viele ihrer Pixel übersteuert sind: Licht über Weiß, das kein Code zeigt</translation>
    </message>
    <message>
        <source>Darkens all other regions</source>
        <translation>Dunkelt alle anderen Regionen ab</translation>
    </message>
    <message>
        <source>Add</source>
        <translation>Neu</translation>
    </message>
    <message>
        <source>A new region, exposed over the interval; paint it with a tool</source>
        <translation>Eine neue Region, über das Intervall belichtet; mit einem Werkzeug zu malen</translation>
    </message>
    <message>
        <source>Remove</source>
        <translation>Entfernen</translation>
    </message>
    <message>
        <source>Its pixels fall to the background</source>
        <translation>Ihre Pixel fallen an den Hintergrund</translation>
    </message>
    <message>
        <source>Colour…</source>
        <translation>Farbe…</translation>
    </message>
    <message>
        <source>Of the region&apos;s outline and curve</source>
        <translation>Für Umriss und Kurve der Region</translation>
    </message>
    <message>
        <source>Up</source>
        <translation>Höher</translation>
    </message>
    <message>
        <source>Before the region above it, which it then covers</source>
        <translation>Vor die Region darüber, die sie dann verdeckt</translation>
    </message>
    <message>
        <source>Down</source>
        <translation>Tiefer</translation>
    </message>
    <message>
        <source>Behind the region below it, which then covers it</source>
        <translation>Hinter die Region darunter, von der sie dann verdeckt wird</translation>
    </message>
    <message>
        <source>Interval</source>
        <translation>Intervall</translation>
    </message>
    <message>
        <source>The interval of the time strip becomes the region&apos;s function</source>
        <translation>Das Intervall der Zeitleiste wird zur Funktion der Region</translation>
    </message>
    <message>
        <source>Grow</source>
        <translation>Größer</translation>
    </message>
    <message>
        <source>By so many pixels</source>
        <translation>Um so viele Pixel</translation>
    </message>
    <message>
        <source>Shrink</source>
        <translation>Kleiner</translation>
    </message>
    <message>
        <source>Smooth</source>
        <translation>Glätten</translation>
    </message>
    <message>
        <source>Without parts and holes narrower than twice that</source>
        <translation>Ohne Teile und Löcher, die schmaler als das Doppelte sind</translation>
    </message>
    <message>
        <source>Pixels to grow, shrink or smooth by</source>
        <translation>Pixel, um die vergrößert, verkleinert oder geglättet wird</translation>
    </message>
    <message>
        <source>Feather: how far all edges are blended, to either side</source>
        <translation>Wie weit alle Kanten überblendet werden, nach jeder Seite</translation>
    </message>
    <message>
        <source>Feather of the selected region&apos;s own edges</source>
        <translation>Wie weit die eigenen Kanten der ausgewählten Region überblendet werden</translation>
    </message>
    <message>
        <source>as all edges</source>
        <translation>wie alle</translation>
    </message>
    <message>
        <source>Grow by</source>
        <translation>Radius</translation>
    </message>
    <message>
        <source>Feather edges</source>
        <translation>Weiche Kanten</translation>
    </message>
    <message>
        <source>Own edges</source>
        <translation>Eigene Kanten</translation>
    </message>
    <message>
        <source>%1, M%2 in mask and function file. Checked: its outline and its curve are shown</source>
        <translation>%1, M%2 in Masken- und Funktionsdatei. Mit Häkchen: Umriss und Kurve werden gezeigt</translation>
    </message>
    <message>
        <source>Rename region</source>
        <translation>Region umbenennen</translation>
    </message>
    <message>
        <source>Show region</source>
        <translation>Region zeigen</translation>
    </message>
    <message>
        <source>Colour of %1</source>
        <translation>Farbe von %1</translation>
    </message>
    <message>
        <source>Colour region</source>
        <translation>Region färben</translation>
    </message>
</context>
<context>
    <name>nutik::studio::StartPage</name>
    <message>
        <source>Open a clip or a capture…</source>
        <translation>Clip oder Aufnahme öffnen…</translation>
    </message>
    <message>
        <source>Ctrl+O; or drop one here</source>
        <translation>Strg+O; oder hier ablegen</translation>
    </message>
    <message>
        <source>Opens a clip, and makes this of it</source>
        <translation>Öffnet einen Clip und macht dies daraus</translation>
    </message>
    <message>
        <source>Recent work</source>
        <translation>Letzte Arbeiten</translation>
    </message>
</context>
<context>
    <name>nutik::studio::StatusLine</name>
    <message>
        <source>Pixel under the pointer</source>
        <translation>Pixel unter dem Zeiger</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>How large the picture is shown: 100 % is pixel for pixel (Ctrl+1), Ctrl+0 shows all of it</source>
        <translation>Wie groß das Bild gezeigt wird: 100 % ist Pixel für Pixel (Strg+1), Strg+0 zeigt das ganze Bild</translation>
    </message>
    <message>
        <source>Pixels brighter than white or darker than black: the picture cannot show how much</source>
        <translation>Pixel heller als Weiß oder dunkler als Schwarz: Um wie viel, kann das Bild nicht zeigen</translation>
    </message>
    <message>
        <source>How long it took from the last change to the picture</source>
        <translation>Wie lange es von der letzten Änderung bis zum Bild dauerte</translation>
    </message>
    <message>
        <source>exact to %1 codes</source>
        <translation>auf %1 Codes genau</translation>
    </message>
    <message>
        <source>preview</source>
        <translation>Vorschau</translation>
    </message>
    <message>
        <source>What rounding may change at most, of 255 codes from black to white. Computed in %1</source>
        <translation>Was Rundung höchstens ändert, von 255 Codes zwischen Schwarz und Weiß. Berechnet in %1</translation>
    </message>
    <message>
        <source>after %1 ms</source>
        <translation>nach %1 ms</translation>
    </message>
    <message>
        <source>%1 px clipped</source>
        <translation>%1 px übersteuert</translation>
    </message>
    <message>
        <source>Zoom %1 %</source>
        <translation>Zoom %1 %</translation>
    </message>
    <message>
        <source>x %1, y %2   light %3  %4  %5 (white: 1)   code %6  %7  %8 (of 255)</source>
        <translation>x %1, y %2   Licht %3  %4  %5 (Weiß: 1)   Code %6  %7  %8 (von 255)</translation>
    </message>
</context>
<context>
    <name>nutik::studio::TimeAxis</name>
    <message>
        <source>&apos;%1&apos; is outside the capture, which has %2 pictures, or is no whole number</source>
        <translation>&apos;%1&apos; liegt außerhalb der Aufnahme, die %2 Bilder hat, oder ist keine ganze Zahl</translation>
    </message>
    <message>
        <source>A number and its unit: 0.4 s, 10 ms, 250 us, 1/100 s, or 37f for the start of picture 37</source>
        <translation>Eine Zahl mit Einheit: 0.4 s, 10 ms, 250 us, 1/100 s, oder 37f für den Anfang von Bild 37</translation>
    </message>
    <message>
        <source>picture %1</source>
        <translation>Bild %1</translation>
    </message>
    <message>
        <source>made sample at %1</source>
        <translation>Sample (erzeugt) bei %1</translation>
    </message>
    <message>
        <source>start of %1</source>
        <translation>Anfang von %1</translation>
    </message>
    <message>
        <source>end of %1</source>
        <translation>Ende von %1</translation>
    </message>
    <message>
        <source>&apos;%1&apos; is not longer than nothing</source>
        <translation>&apos;%1&apos; ist nicht länger als nichts</translation>
    </message>
    <message>
        <source>&apos;%1&apos; is no gain; write a number such as 1, -0.5 or 2e-3</source>
        <translation>&apos;%1&apos; ist kein Gain; schreiben Sie eine Zahl wie 1, -0.5 oder 2e-3</translation>
    </message>
    <message>
        <source>&apos;%1&apos; is no time of up to 126 years; write a number and a unit: 0.4 s, 10 ms, 1/100 s or 37f</source>
        <translation>&apos;%1&apos; ist keine Zeit bis 126 Jahre; schreiben Sie Zahl und Einheit: 0.4 s, 10 ms, 1/100 s oder 37f</translation>
    </message>
</context>
<context>
    <name>nutik::studio::TimeFields</name>
    <message>
        <source>A number and its unit: 0.4 s, 10 ms, 250 us, 1/100 s, or 37f for 37 pictures</source>
        <translation>Eine Zahl mit Einheit: 0.4 s, 10 ms, 250 us, 1/100 s, oder 37f für 37 Bilder</translation>
    </message>
    <message>
        <source>S&amp;tart</source>
        <translation>S&amp;tart</translation>
    </message>
    <message>
        <source>Where the exposed interval begins. %1</source>
        <translation>Wo das belichtete Intervall beginnt. %1</translation>
    </message>
    <message>
        <source>&amp;Width</source>
        <translation>&amp;Länge</translation>
    </message>
    <message>
        <source>How long the exposed interval is. %1</source>
        <translation>Wie lang das belichtete Intervall ist. %1</translation>
    </message>
    <message>
        <source>&amp;In</source>
        <translation>&amp;In</translation>
    </message>
    <message>
        <source>Where work begins, or nothing. %1</source>
        <translation>Wo die Arbeit beginnt, oder nichts. %1</translation>
    </message>
    <message>
        <source>&amp;Out</source>
        <translation>&amp;Out</translation>
    </message>
    <message>
        <source>Where work ends, or nothing. %1</source>
        <translation>Wo die Arbeit endet, oder nichts. %1</translation>
    </message>
    <message>
        <source>Exposed pictures</source>
        <translation>Belichtete Bilder</translation>
    </message>
    <message>
        <source>An interval of this width lies within the capture if it starts between 0 s and %1</source>
        <translation>Ein Intervall dieser Länge liegt in der Aufnahme, wenn es zwischen 0 s und %1 beginnt</translation>
    </message>
    <message>
        <source>Set start</source>
        <translation>Start setzen</translation>
    </message>
    <message>
        <source>The capture lasts %1: the width can be no more</source>
        <translation>Die Aufnahme dauert %1: Länger kann das Intervall nicht sein</translation>
    </message>
    <message>
        <source>Set width</source>
        <translation>Länge setzen</translation>
    </message>
    <message>
        <source>Marks lie within the capture, between 0 s and %1</source>
        <translation>Marken liegen in der Aufnahme, zwischen 0 s und %1</translation>
    </message>
    <message>
        <source>%1: %2</source>
        <translation>%1: %2</translation>
    </message>
</context>
<context>
    <name>nutik::studio::TimeStrip</name>
    <message>
        <source>Scrub</source>
        <translation>Intervall verschieben</translation>
    </message>
    <message>
        <source>Expose from mark to mark</source>
        <translation>Von Marke zu Marke belichten</translation>
    </message>
    <message>
        <source>In: %1
Drag to move it, right click to take it away</source>
        <translation>In: %1
Ziehen verschiebt die Marke, Rechtsklick entfernt sie</translation>
    </message>
    <message>
        <source>Out: %1
Drag to move it, right click to take it away</source>
        <translation>Out: %1
Ziehen verschiebt die Marke, Rechtsklick entfernt sie</translation>
    </message>
    <message>
        <source>Drag to move the interval&apos;s begin</source>
        <translation>Ziehen verschiebt den Anfang des Intervalls</translation>
    </message>
    <message>
        <source>Drag to move the interval&apos;s end</source>
        <translation>Ziehen verschiebt das Ende des Intervalls</translation>
    </message>
    <message>
        <source>Exposed: %1</source>
        <translation>Belichtet: %1</translation>
    </message>
    <message>
        <source>Outside the capture</source>
        <translation>Außerhalb der Aufnahme</translation>
    </message>
    <message>
        <source>Picture %1, from %2</source>
        <translation>Bild %1, ab %2</translation>
    </message>
    <message>
        <source>Made sample, from %1</source>
        <translation>Erzeugtes Sample, ab %1</translation>
    </message>
    <message>
        <source>
%1 % of the pixels change</source>
        <translation>
%1 % der Pixel ändern sich</translation>
    </message>
    <message>
        <source>pictures %1 to %2</source>
        <translation>Bilder %1–%2</translation>
    </message>
    <message>
        <source>%1 to %2</source>
        <translation>%1 bis %2</translation>
    </message>
    <message>
        <source>%1 to %2, %3</source>
        <translation>%1 bis %2, %3</translation>
    </message>
    <message>
        <source>Time</source>
        <translation>Zeit</translation>
    </message>
    <message>
        <source>Exposed interval: %1</source>
        <translation>Belichtetes Intervall: %1</translation>
    </message>
    <message>
        <source>change</source>
        <translation>Bewegung</translation>
    </message>
    <message>
        <source>
Click to bring the interval here</source>
        <translation>
Klick holt das Intervall hierher</translation>
    </message>
</context>
</TS>
